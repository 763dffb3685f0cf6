// SPDX-License-Identifier: Apache-2.0
#include <nets/network.h>

#include <array>
#include <filesystem>
#include <new>
#include <optional>
#include <span>
#include <utility>

#include <opencv2/dnn.hpp>

#include <hc/base/check.h>
#include <hc/base/format.h>
#include <nets/depthwise.h>
#include <nets/face_api.h>
#include <nets/fusion.h>
#include <nets/pointwise.h>
#include <nets/shapes.h>
#include <nets/tflite.h>
#include <nets/weights.h>

namespace hc::nets {
namespace {

/// Images are (1, channels, height, width) in OpenCV, and (1, height, width, channels) in files.
bool is_image(const Shape& shape) {
  return shape.size() == 4;
}

/// Weights with their axes in another order.
cv::Mat weights(const Tensor& tensor, const std::array<int, 4>& order) {
  const Shape& shape = tensor.shape;
  Shape to(4);
  std::array<std::size_t, 4> steps{};  // in the file
  for (std::size_t i = 0; i < 4; ++i) {
    to[i] = shape[static_cast<std::size_t>(order[i])];
    steps[i] = 1;
    for (auto k = static_cast<std::size_t>(order[i]) + 1; k < 4; ++k)
      steps[i] *= static_cast<std::size_t>(shape[k]);
  }
  cv::Mat made(to, CV_32F);
  auto* into = made.ptr<float>();
  for (std::size_t a = 0; a < static_cast<std::size_t>(to[0]); ++a)
    for (std::size_t b = 0; b < static_cast<std::size_t>(to[1]); ++b)
      for (std::size_t c = 0; c < static_cast<std::size_t>(to[2]); ++c)
        for (std::size_t d = 0; d < static_cast<std::size_t>(to[3]); ++d)
          *into++ = tensor.numbers[a * steps[0] + b * steps[1] + c * steps[2] + d * steps[3]];
  return made;
}

cv::Mat row(const std::vector<float>& numbers) {
  return cv::Mat(numbers, true).reshape(1, 1);
}

/// Builds OpenCV's layers from ours, whose shapes are right.
class Builder {
 public:
  explicit Builder(const Layers& layers)
      : layers_(layers),
        fusion_(layers),
        is_fused_(layers.layers.size()),
        places_(layers.tensors.size()) {
    places_[static_cast<std::size_t>(layers.input)] = 0;  // OpenCV's layer 0 is the input
    register_depthwise();
    register_pointwise();
  }

  cv::dnn::Net build() {
    for (std::size_t i = 0; i < layers_.layers.size(); ++i)
      if (!is_fused_[i]) add(i);
    // An output by its own name, in OpenCV's order of axes for images.
    for (const int output : layers_.outputs) names_.push_back(net_.getLayer(place(output))->name);
    return net_;
  }
  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }

 private:
  using Params = cv::dnn::LayerParams;

  [[nodiscard]] const Tensor& tensor(int number) const {
    return layers_.tensors[static_cast<std::size_t>(number)];
  }
  [[nodiscard]] int place(int number) const { return *places_[static_cast<std::size_t>(number)]; }

  /// A layer that takes one result, or several.
  int put(const std::string& type, Params& params, const std::vector<int>& from) {
    const int id = net_.addLayer(hc::format("{} {}", type, ++count_), type, params);
    for (std::size_t i = 0; i < from.size(); ++i) net_.connect(from[i], 0, id, static_cast<int>(i));
    return id;
  }
  int put(const std::string& type, Params& params, int from) {
    return put(type, params, std::vector<int>{from});
  }
  int put(const std::string& type, int from) {
    Params params;
    return put(type, params, from);
  }

  /// Padding by (before, after) of each of OpenCV's axes.
  int pad(const std::vector<int>& by, int from) {
    Params params;
    params.set("paddings", cv::dnn::DictValue::arrayInt(by.data(), static_cast<int>(by.size())));
    return put("Padding", params, from);
  }

  /// Sets a window's sizes and padding; OpenCV's convolution has the same padding before and after.
  int place_window(const Layer& layer, const Window& window, Params& params, int from) {
    params.set("kernel_h", window.height);
    params.set("kernel_w", window.width);
    params.set("stride_h", layer.stride_down);
    params.set("stride_w", layer.stride_right);
    const bool is_even = window.top == window.bottom && window.left == window.right;
    if (!is_even && layer.kind == Kind::Convolution)
      return pad({0, 0, 0, 0, window.top, window.bottom, window.left, window.right}, from);
    params.set("pad_t", window.top);
    params.set("pad_b", window.bottom);
    params.set("pad_l", window.left);
    params.set("pad_r", window.right);
    return from;
  }

  void add(std::size_t number) {
    const Layer& layer = layers_.layers[number];
    if (is_pointwise(layer)) return add_pointwise(layer, fusion_.of(number));
    int made = make(layer);
    if (layer.kind != Kind::DepthwiseConvolution) {  // it has its activation itself
      if (layer.activation == Kind::Relu) made = put("ReLU", made);
      if (layer.activation == Kind::Relu6) made = put("ReLU6", made);
    }
    places_[static_cast<std::size_t>(layer.output)] = made;
  }

  int make(const Layer& layer) {
    const int from = place(layer.inputs[0]);
    const Shape& shape = tensor(layer.inputs[0]).shape;
    const Shape& to = tensor(layer.output).shape;
    Params params;
    switch (layer.kind) {
      case Kind::Add: {
        params.set("operation", "sum");
        return put("Eltwise", params, {from, place(layer.inputs[1])});
      }
      case Kind::Concatenation: {
        constexpr int kAxes[] = {0, 2, 3, 1};
        params.set("axis", is_image(shape) ? kAxes[axis_of(layer, shape)] : axis_of(layer, shape));
        std::vector<int> all;
        for (const int each : layer.inputs) all.push_back(place(each));
        return put("Concat", params, all);
      }
      case Kind::DepthwiseConvolution:
        return depthwise(layer, from, shape, to);
      case Kind::Convolution: {
        const Tensor& of = tensor(layer.inputs[1]);
        params.blobs.push_back(weights(of, {0, 3, 1, 2}));
        params.set("num_output", to[3]);
        params.set("bias_term", layer.inputs.size() > 2);
        if (layer.inputs.size() > 2) params.blobs.push_back(row(tensor(layer.inputs[2]).numbers));
        const int placed = place_window(layer, window_of(layer, shape, of.shape), params, from);
        return put("Convolution", params, placed);
      }
      case Kind::FullyConnected: {
        const Tensor& of = tensor(layer.inputs[1]);
        params.blobs.push_back(cv::Mat(of.numbers, true).reshape(1, of.shape[0]));
        params.set("num_output", of.shape[0]);
        params.set("bias_term", layer.inputs.size() > 2);
        if (layer.inputs.size() > 2) params.blobs.push_back(row(tensor(layer.inputs[2]).numbers));
        return put("InnerProduct", params, from);
      }
      case Kind::Logistic:
        return put("Sigmoid", from);
      case Kind::AveragePool:
      case Kind::MaxPool: {
        params.set("pool", layer.kind == Kind::MaxPool ? "MAX" : "AVE");
        params.set("ave_pool_padded_area", false);
        params.set("ceil_mode", false);
        return put("Pooling", params,
                   place_window(layer, window_of(layer, shape, {}), params, from));
      }
      case Kind::Mean: {
        params.set("pool", "AVE");
        params.set("global_pooling", true);
        const int mean = put("Pooling", params, from);
        return is_image(to) ? mean : reshape(mean, to);
      }
      case Kind::Pad: {
        const auto& by = tensor(layer.inputs[1]).integers;
        return pad({by[0], by[1], by[6], by[7], by[2], by[3], by[4], by[5]}, from);
      }
      case Kind::Prelu: {
        params.blobs.push_back(row(tensor(layer.inputs[1]).numbers));
        return put("PReLU", params, from);
      }
      case Kind::Relu:
        return put("ReLU", from);
      case Kind::Relu6:
        return put("ReLU6", from);
      case Kind::Reshape:
        return reshape(is_image(shape) ? channels_last(from) : from, to);
      case Kind::ResizeBilinear: {
        params.set("interpolation", "bilinear");
        params.set("height", to[1]);
        params.set("width", to[2]);
        params.set("align_corners", layer.align_corners);
        params.set("half_pixel_centers", layer.half_pixel_centers);
        return put("Resize", params, from);
      }
    }
    return from;
  }

  /// Whether we compute a convolution ourselves: its window and strides are of one pixel, and its
  /// channels so few that a block of pixels of all of them is small.
  [[nodiscard]] bool is_pointwise(const Layer& layer) const {
    constexpr int kMostChannels = 4096;
    if (layer.kind != Kind::Convolution || layer.stride_down != 1 || layer.stride_right != 1)
      return false;
    const Shape& of = tensor(layer.inputs[1]).shape;
    return of[1] == 1 && of[2] == 1 && of[3] <= kMostChannels;
  }

  void add_pointwise(const Layer& layer, const Fused& fused) {
    for (const std::size_t each : fused.layers) is_fused_[each] = true;
    const Tensor& of = tensor(layer.inputs[1]);
    const auto channels = static_cast<std::size_t>(of.shape[0]);
    PointwiseConvolution::Activation activation{
        fused.slopes ? tensor(*fused.slopes).numbers
                     : std::vector<float>(channels, fused.activation ? 0.0F : 1.0F)};
    if (fused.activation == Kind::Relu6) activation.max = 6;
    auto params = pointwise_params(cv::Mat(of.numbers, true).reshape(1, of.shape[0]),
                                   bias(layer, channels), activation);
    std::vector<int> from{place(layer.inputs[0])};
    if (fused.addend) from.push_back(place(*fused.addend));
    places_[static_cast<std::size_t>(fused.output)] = put(kPointwise, params, from);
  }

  /// The bias of a convolution, or zeros.
  [[nodiscard]] cv::Mat bias(const Layer& layer, std::size_t channels) const {
    return row(layer.inputs.size() > 2 ? tensor(layer.inputs[2]).numbers
                                       : std::vector<float>(channels));
  }

  /// With its activation.
  int depthwise(const Layer& layer, int from, const Shape& shape, const Shape& to) {
    const Tensor& of = tensor(layer.inputs[1]);
    PlaneConvolution::Options options{window_of(layer, shape, of.shape), layer.stride_down,
                                      layer.stride_right};
    if (layer.activation) options.min = 0;
    if (layer.activation == Kind::Relu6) options.max = 6;
    auto params = depthwise_params(options, {to[2], to[1]});
    params.blobs = {weights(of, {3, 0, 1, 2}), bias(layer, static_cast<std::size_t>(shape[3]))};
    return put(kDepthwise, params, from);
  }

  int channels_last(int from) {
    Params params;
    constexpr int kOrder[] = {0, 2, 3, 1};
    params.set("order", cv::dnn::DictValue::arrayInt(kOrder, 4));
    return put("Permute", params, from);
  }
  int reshape(int from, const Shape& to) {
    Params params;
    params.set("dim", cv::dnn::DictValue::arrayInt(to.data(), static_cast<int>(to.size())));
    return put("Reshape", params, from);
  }

  const Layers& layers_;
  const Fusion fusion_;
  std::vector<bool> is_fused_;              // into a convolution before it
  std::vector<std::optional<int>> places_;  // of tensors that are computed: OpenCV's layers
  cv::dnn::Net net_;
  std::vector<std::string> names_;
  int count_ = 0;
};

/// (1, channels, height, width)
cv::Mat channels_first(const cv::Mat& image) {
  cv::Mat made(Shape{1, image.channels(), image.rows, image.cols}, CV_32F);
  std::vector<cv::Mat> planes;
  planes.reserve(static_cast<std::size_t>(image.channels()));
  for (int i = 0; i < image.channels(); ++i)
    planes.emplace_back(image.rows, image.cols, CV_32F, made.ptr<float>(0, i));
  cv::split(image, planes);
  return made;
}

class OpencvNetwork final : public Network {
 public:
  explicit OpencvNetwork(const Layers& layers) {
    const Shape& shape = layers.tensors[static_cast<std::size_t>(layers.input)].shape;
    input_.assign(shape.begin() + 1, shape.end());
    Builder builder(layers);
    net_ = builder.build();
    names_ = builder.names();
    for (const int output : layers.outputs)
      shapes_.push_back(layers.tensors[static_cast<std::size_t>(output)].shape);
  }

  /// Computes it once, since that is when OpenCV checks its layers: run() fails only without memory
  /// after it.
  Status try_out() {
    const auto outputs = forward(cv::Mat::zeros(input_[0], input_[1], CV_32FC(input_[2])));
    for (std::size_t i = 0; i < shapes_.size(); ++i)
      if (static_cast<long long>(outputs[i].total()) != size_of(shapes_[i]))
        return Error{Code::Unsupported, hc::format("OpenCV computes {} numbers for an output of {}",
                                                   outputs[i].total(), text(shapes_[i]))};
    return {};
  }

  [[nodiscard]] const Shape& input() const override { return input_; }

  std::vector<cv::Mat> run(const cv::Mat& image) override {
    HC_CHECK(
        image.rows == input_[0] && image.cols == input_[1] && image.type() == CV_32FC(input_[2]),
        image.rows, image.cols, image.type());
    auto outputs = forward(image);
    for (std::size_t i = 0; i < outputs.size(); ++i)  // views OpenCV's memory no more
      outputs[i] = outputs[i].reshape(1, rows_of(shapes_[i])).clone();
    return outputs;
  }

 private:
  std::vector<cv::Mat> forward(const cv::Mat& image) {
    net_.setInput(channels_first(image));
    std::vector<cv::Mat> outputs;
    net_.forward(outputs, names_);
    return outputs;
  }
  static int rows_of(const Shape& shape) { return static_cast<int>(size_of(shape) / shape.back()); }

  Shape input_;
  cv::dnn::Net net_;
  std::vector<std::string> names_;
  std::vector<Shape> shapes_;
};

/// Those of a file of TensorFlow Lite, or of face-api's manifest and the weights beside it.
template <typename Named>
Result<Layers> read_layers(const std::string& path, std::optional<std::array<int, 2>> size,
                           const Named& named) {
  const auto bytes = HC_TRY(read_weights(path));
  auto layers = Result<Layers>(Layers());
  if (const std::filesystem::path manifest = path; manifest.extension() == ".json") {
    const auto weights =
        HC_TRY(read_weights(std::filesystem::path(path).replace_extension(".bin")));
    layers = read_face_recognition(bytes, std::as_bytes(std::span(weights)));
  } else {
    layers = read_tflite(std::as_bytes(std::span(bytes)));
  }
  if (layers && size) layers = resized(*std::move(layers), (*size)[0], (*size)[1]);
  if (!layers) return named(layers.error());
  return layers;
}

}  // namespace

Result<std::unique_ptr<Network>> Network::read(const std::string& path,
                                               std::optional<std::array<int, 2>> size) {
  const auto named = [&](const Error& error) {
    return Error{error.code, hc::format("{}: {}", path, error.detail)};
  };
  const auto layers = HC_TRY(read_layers(path, size, named));
  auto made = make(layers);
  if (!made) return named(made.error());
  return made;
}

Result<std::unique_ptr<Network>> Network::make(const Layers& layers) {
  HC_TRY(check_shapes(layers));
  try {
    auto network = std::make_unique<OpencvNetwork>(layers);
    HC_TRY(network->try_out());
    return std::unique_ptr<Network>(std::move(network));
  } catch (const std::bad_alloc&) {
    return Error{Code::TooLarge, "there is not enough memory for it"};
  } catch (const cv::Exception& failed) {
    return Error{Code::Unsupported, "OpenCV cannot compute it: " + failed.err};
  }
}

}  // namespace hc::nets
