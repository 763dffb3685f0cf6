// SPDX-License-Identifier: Apache-2.0
#include <nets/shapes.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include <hc/base/format.h>
#include <nets/network.h>

namespace hc::nets {
namespace {

constexpr int kMostStride = 64;  // of a window, and its sides [px]

/// The zeros before and after a side, of TensorFlow's SAME: an odd one comes after.
void surround(int side, int window, int stride, int& before, int& after) {
  const int steps = (side + stride - 1) / stride;
  const int all = std::max(0, (steps - 1) * stride + window - side);
  before = all / 2;
  after = all - before;
}

std::string_view name(Kind kind) {
  constexpr std::string_view kNames[] = {"addition",
                                         "average pool",
                                         "concatenation",
                                         "convolution",
                                         "depthwise convolution",
                                         "fully connected layer",
                                         "logistic function",
                                         "max pool",
                                         "mean",
                                         "padding",
                                         "PReLU",
                                         "ReLU",
                                         "ReLU6",
                                         "reshape",
                                         "resize"};
  return kNames[static_cast<std::size_t>(kind)];
}

/// How many inputs a kind of layer has.
struct Count {
  std::size_t least, most, computed;  // the first `computed` are no constants
};
Count inputs_of(Kind kind) {
  switch (kind) {
    case Kind::Add:
      return {2, 2, 2};
    case Kind::Concatenation:
      return {1, 16, 16};
    case Kind::Convolution:
    case Kind::DepthwiseConvolution:
    case Kind::FullyConnected:
      return {2, 3, 1};
    case Kind::Mean:
    case Kind::Pad:
    case Kind::Prelu:
    case Kind::ResizeBilinear:
      return {2, 2, 1};
    case Kind::Reshape:
      return {1, 2, 1};
    default:
      return {1, 1, 1};
  }
}

bool is_activation(Kind kind) {
  return kind == Kind::Relu || kind == Kind::Relu6 || kind == Kind::Prelu;
}

/// Checks the layers, one after the other.
class Check {
 public:
  explicit Check(const Layers& layers) : layers_(layers), is_computed_(layers.tensors.size()) {}

  Status run() {
    const Shape& input = tensor(layers_.input).shape;
    if (input.size() != 4 || input[0] != 1)
      return Error{Code::Unsupported, hc::format("an input of {}, not of one image", text(input))};
    if (tensor(layers_.input).is_constant()) return malformed("its input is a constant");
    mark(layers_.input);
    for (const Layer& layer : layers_.layers) {
      layer_ = &layer;
      HC_TRY(check());
      mark(layer.output);
    }
    layer_ = nullptr;
    for (const int output : layers_.outputs) {
      if (!is_computed(output) || output == layers_.input)
        return malformed("output " + tensor(output).name + " is not computed");
      if (tensor(output).shape.size() > 3 || tensor(output).shape.empty())
        return Error{Code::Unsupported, "an output of " + text(tensor(output).shape)};
    }
    return {};
  }

 private:
  [[nodiscard]] const Tensor& tensor(int number) const {
    return layers_.tensors[static_cast<std::size_t>(number)];
  }
  [[nodiscard]] const Shape& shape(std::size_t input) const {
    return tensor(layer_->inputs[input]).shape;
  }
  [[nodiscard]] bool is_computed(int number) const {
    return is_computed_[static_cast<std::size_t>(number)];
  }
  void mark(int number) { is_computed_[static_cast<std::size_t>(number)] = true; }

  [[nodiscard]] Error malformed(const std::string& what) const {
    std::string where;
    if (layer_ != nullptr)
      where = hc::format("{} {}: ", name(layer_->kind), tensor(layer_->output).name);
    return {Code::Malformed, where + what};
  }
  /// That the result has a shape.
  [[nodiscard]] Status is(const Shape& made) const {
    const Shape& said = tensor(layer_->output).shape;
    if (said == made) return {};
    return malformed(hc::format("its shape is {}, not {}", text(made), text(said)));
  }
  [[nodiscard]] Status is_image(const Shape& shape) const {
    if (shape.size() == 4 && shape[0] == 1) return {};
    return malformed("of " + text(shape) + ", which is no image");
  }

  Status check() {
    const auto count = inputs_of(layer_->kind);
    const auto& inputs = layer_->inputs;
    if (inputs.size() < count.least || inputs.size() > count.most)
      return malformed(hc::format("{} inputs", inputs.size()));
    for (std::size_t i = 0; i < inputs.size(); ++i) {
      const Tensor& one = tensor(inputs[i]);
      if (i < count.computed ? !is_computed(inputs[i]) : !one.is_constant())
        return malformed(
            one.name + (i < count.computed ? " is not computed before it" : " is not a constant"));
    }
    if (is_computed(layer_->output) || tensor(layer_->output).is_constant())
      return malformed("computed twice");
    if (tensor(layer_->output).shape.empty()) return malformed("a result without extents");
    if (layer_->activation && (is_activation(layer_->kind) || *layer_->activation == Kind::Prelu ||
                               !is_activation(*layer_->activation)))
      return malformed("its activation is neither ReLU nor ReLU6, or its second one");
    return check_shape();
  }

  Status check_shape() {
    const Shape& from = shape(0);
    switch (layer_->kind) {
      case Kind::Add:
        if (shape(1) != from) return malformed(text(from) + " and " + text(shape(1)));
        return is(from);
      case Kind::Concatenation:
        return check_concatenation();
      case Kind::Convolution:
      case Kind::DepthwiseConvolution:
        return check_convolution();
      case Kind::FullyConnected:
        return check_connections();
      case Kind::AveragePool:
      case Kind::MaxPool: {
        const Shape made = HC_TRY(windows({layer_->window_height, layer_->window_width}, {}));
        HC_TRY(multiply(1LL * made[0] * made[1] * from[3] * layer_->window_height *
                        layer_->window_width));
        return is({1, made[0], made[1], from[3]});
      }
      case Kind::Mean:
        return check_mean();
      case Kind::Pad:
        return check_padding();
      case Kind::Prelu:
        HC_TRY(is_image(from));
        HC_TRY(numbers(1, from[3]));
        return is(from);
      case Kind::Reshape:
        if (size_of(from) != size_of(tensor(layer_->output).shape) ||
            tensor(layer_->output).shape.size() > 3)
          return malformed(text(from) + " to " + text(tensor(layer_->output).shape));
        return {};
      case Kind::ResizeBilinear: {
        HC_TRY(is_image(from));
        const auto& to = tensor(layer_->inputs[1]).integers;
        if (to.size() != 2) return malformed("without a size");
        if (layer_->align_corners && layer_->half_pixel_centers)
          return malformed("of both pixels' corners and centres");
        return is({1, to[0], to[1], from[3]});
      }
      default:
        return is(from);
    }
  }

  /// That a constant has so many numbers. Each layer that takes it will have a copy of them.
  [[nodiscard]] Status numbers(std::size_t input, long long count) {
    const auto& all = tensor(layer_->inputs[input]).numbers;
    weights_ += count;
    if (static_cast<long long>(all.size()) == count) {
      if (weights_ <= kMostNumbers) return {};
      return Error{Code::TooLarge, hc::format("layers with more than {} weights", kMostNumbers)};
    }
    return malformed(hc::format("{} has {} numbers, not {}", tensor(layer_->inputs[input]).name,
                                all.size(), count));
  }

  /// (height, width) of what a window goes over.
  [[nodiscard]] Result<Shape> windows(std::array<int, 2> sides, const Shape& weights) const {
    HC_TRY(is_image(shape(0)));
    for (const int each : {sides[0], sides[1], layer_->stride_down, layer_->stride_right})
      if (each < 1 || each > kMostStride)
        return malformed(hc::format("a window or stride of {}", each));
    const Shape& from = shape(0);
    const Window window = window_of(*layer_, from, weights);
    const int down = from[1] + window.top + window.bottom - window.height;
    const int right = from[2] + window.left + window.right - window.width;
    if (down < 0 || right < 0) return malformed("a window larger than the image");
    if (1LL * (down + window.height) * (right + window.width) * from[3] > kMostNumbers)
      return Error{Code::TooLarge,
                   hc::format("more than {} numbers with the padding", kMostNumbers)};
    return Shape{down / layer_->stride_down + 1, right / layer_->stride_right + 1};
  }

  Status check_convolution() {
    const Shape& of = shape(1);
    const bool is_deep = layer_->kind == Kind::DepthwiseConvolution;
    if (of.size() != 4) return malformed("with weights of " + text(of));
    const Shape made = HC_TRY(windows({of[1], of[2]}, of));
    const int channels = shape(0)[3], out = is_deep ? of[3] : of[0];
    if (is_deep ? of[0] != 1 || out != channels : of[3] != channels)
      return malformed("with weights of " + text(of) + " for " + text(shape(0)));
    HC_TRY(numbers(1, size_of(of)));
    if (layer_->inputs.size() > 2) HC_TRY(numbers(2, out));
    // A depthwise one computes sums for all columns, also where the window extends beyond them.
    const Window window = window_of(*layer_, shape(0), of);
    const int right = layer_->stride_right;
    const int columns = (shape(0)[2] + window.left + window.right + right - 1) / right;
    HC_TRY(multiply(size_of(of) * made[0] * (is_deep ? columns : made[1])));
    return is({1, made[0], made[1], out});
  }

  Status check_connections() {
    const Shape& of = shape(1);
    if (of.size() != 2 || size_of(shape(0)) != of[1] || shape(0).size() > 2)
      return malformed("with weights of " + text(of) + " for " + text(shape(0)));
    HC_TRY(numbers(1, size_of(of)));
    if (layer_->inputs.size() > 2) HC_TRY(numbers(2, of[0]));
    HC_TRY(multiply(size_of(of)));
    return is({1, of[0]});
  }

  /// Counts multiplications. Each factor is bounded, so that their product is no overflow.
  Status multiply(long long times) {
    multiplications_ += times;
    if (times >= 0 && multiplications_ <= kMostMultiplications) return {};
    return Error{Code::TooLarge, hc::format("more than {} multiplications", kMostMultiplications)};
  }

  Status check_concatenation() {
    Shape made = shape(0);
    const auto axis = static_cast<std::size_t>(axis_of(*layer_, made));
    if (axis >= made.size()) return malformed(hc::format("along axis {}", layer_->axis));
    made[axis] = 0;
    for (std::size_t i = 0; i < layer_->inputs.size(); ++i) {
      Shape other = shape(i);
      if (other.size() != made.size()) return malformed(text(made) + " and " + text(other));
      made[axis] += std::exchange(other[axis], made[axis]);
      other[axis] = made[axis];
      if (other != made) return malformed(text(made) + " and " + text(other));
    }
    return is(made);
  }

  Status check_mean() {
    const Shape& from = shape(0);
    HC_TRY(is_image(from));
    auto axes = tensor(layer_->inputs[1]).integers;
    std::sort(axes.begin(), axes.end());
    if (axes != std::vector<int>{1, 2})
      return Error{Code::Unsupported, "a mean of other axes than height and width"};
    return tensor(layer_->output).shape.size() == 4 ? is({1, 1, 1, from[3]}) : is({1, from[3]});
  }

  Status check_padding() {
    HC_TRY(is_image(shape(0)));
    const auto& by = tensor(layer_->inputs[1]).integers;
    const bool is_sane =
        by.size() == 8 && by[0] == 0 && by[1] == 0 &&
        std::all_of(by.begin(), by.end(), [](int n) { return n >= 0 && n < 65536; });
    if (!is_sane) return malformed("by numbers that are not 4 × (before, after)");
    Shape made = shape(0);
    for (std::size_t i = 0; i < made.size(); ++i) made[i] += by[2 * i] + by[2 * i + 1];
    return is(made);
  }

  const Layers& layers_;
  std::vector<bool> is_computed_;
  const Layer* layer_ = nullptr;
  long long multiplications_ = 0, weights_ = 0;
};

}  // namespace

Window window_of(const Layer& layer, const Shape& image, const Shape& weights) {
  Window window{layer.window_height, layer.window_width};
  if (!weights.empty()) window = {weights[1], weights[2]};
  if (!layer.is_padded) return window;
  surround(image[1], window.height, layer.stride_down, window.top, window.bottom);
  surround(image[2], window.width, layer.stride_right, window.left, window.right);
  return window;
}

int axis_of(const Layer& layer, const Shape& shape) {
  return layer.axis < 0 ? layer.axis + static_cast<int>(shape.size()) : layer.axis;
}

Status check_shapes(const Layers& layers) {
  return Check(layers).run();
}

Result<Layers> resized(Layers layers, int height, int width) {
  HC_TRY(check_shapes(layers));
  const auto tensor = [&](int number) -> Tensor& {
    return layers.tensors[static_cast<std::size_t>(number)];
  };
  const Shape from = tensor(layers.input).shape;
  const Shape to{1, height, width, from[3]};
  const long long pixels = 1LL * height * width, pixels_before = 1LL * from[1] * from[2];
  const auto too_large = [] {
    return Error{Code::TooLarge, hc::format("results with more than {} numbers", kMostNumbers)};
  };
  if (pixels > kMostNumbers) return too_large();
  const auto scale = [](int& extent, long long by, long long of) {
    const long long made = extent * by;
    if (made <= 0 || made % of != 0 || made / of > kMostNumbers) return false;
    extent = static_cast<int>(made / of);
    return true;
  };
  tensor(layers.input).shape = to;
  long long count = pixels * from[3];
  for (const Layer& layer : layers.layers) {
    Shape& shape = tensor(layer.output).shape;
    const std::string before = text(shape);
    count += size_of(shape) * pixels / pixels_before;
    if (count > kMostNumbers) return too_large();
    const bool is_whole = shape.size() == 4
                              ? scale(shape[1], height, from[1]) && scale(shape[2], width, from[2])
                              : shape.size() > 1 && scale(shape[1], pixels, pixels_before);
    if (!is_whole)
      return Error{Code::Unsupported,
                   hc::format("a result of {} for an image of {} has no size for one of {}", before,
                              text(from), text(to))};
    if (layer.kind == Kind::ResizeBilinear) tensor(layer.inputs[1]).integers = {shape[1], shape[2]};
  }
  const auto checked = check_shapes(layers);
  if (checked) return layers;
  if (checked.error().code == Code::TooLarge) return checked.error();
  return Error{Code::Unsupported,
               hc::format("a network for images of {} alone, not of {}", text(from), text(to))};
}

}  // namespace hc::nets
