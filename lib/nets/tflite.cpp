// SPDX-License-Identifier: Apache-2.0
#include <nets/tflite.h>

#include <algorithm>
#include <cstring>
#include <optional>
#include <string>

#include <opencv2/core.hpp>

#include <hc/base/format.h>
#include <nets/flat.h>

namespace hc::nets {
namespace {

using flat::Bytes;
using flat::Table;
using flat::Vector;

// The schema's numbers of fields, of those that are read.
constexpr std::size_t kOperatorCodes = 1, kSubgraphs = 2, kBuffers = 4;  // of a model
constexpr std::size_t kOldCode = 0, kCode = 3;                           // of an operator's code
constexpr std::size_t kTensors = 0, kGraphInputs = 1, kGraphOutputs = 2, kOperators = 3;
constexpr std::size_t kShape = 0, kType = 1, kBuffer = 2, kTensorName = 3;
constexpr std::size_t kCodeIndex = 0, kInputs = 1, kOutputs = 2, kOptions = 4;  // of an operator
constexpr std::size_t kData = 0;                                                // of a buffer

enum class Type : std::uint8_t { Float32 = 0, Float16 = 1, Int32 = 2 };

constexpr int kDequantize = 6;  // of weights of 16 bits: done while reading

constexpr std::size_t kMostTensors = 4096, kMostExtents = 4;
constexpr std::size_t kMostEnds = 32;  // inputs or outputs, of an operator or the graph

/// An operator's number in the schema, and its layer.
struct Known {
  int code;
  Kind kind;
};
constexpr Known kKnown[] = {
    {0, Kind::Add},
    {1, Kind::AveragePool},
    {2, Kind::Concatenation},
    {3, Kind::Convolution},
    {4, Kind::DepthwiseConvolution},
    {9, Kind::FullyConnected},
    {14, Kind::Logistic},
    {17, Kind::MaxPool},
    {19, Kind::Relu},
    {21, Kind::Relu6},
    {22, Kind::Reshape},
    {23, Kind::ResizeBilinear},
    {34, Kind::Pad},
    {40, Kind::Mean},
    {54, Kind::Prelu},
};

Error malformed(const std::string& what) {
  return {Code::Malformed, what};
}

/// At most so many: many vectors may share the bytes of a large one.
std::vector<int> integers(const Vector& vector, std::size_t most) {
  if (vector.size() > most) return std::vector<int>(most + 1);
  const auto bytes = vector.bytes(sizeof(std::int32_t));
  std::vector<int> numbers(bytes.size() / sizeof(std::int32_t));
  if (!numbers.empty()) std::memcpy(numbers.data(), bytes.data(), bytes.size());
  return numbers;
}

/// Reads one file.
class Reader {
 public:
  explicit Reader(std::span<const std::byte> bytes) : bytes_(bytes), all_(bytes) {}

  Result<Layers> read() {
    constexpr std::uint32_t kIdentifier = 0x334c4654;  // "TFL3"
    if (bytes_.at<std::uint32_t>(4) != kIdentifier)
      return malformed("not a file of TensorFlow Lite: it does not have TFL3 at byte 4");
    const Table model = Table::root(bytes_);
    if (!model.tables(kOperatorCodes, kMostTensors, [&](const Table& code) {
          // Files before version 3a have the old, narrow field alone.
          codes_.push_back(
              std::max<int>(code.number<std::int8_t>(kOldCode), code.number<std::int32_t>(kCode)));
        }))
      return malformed("too many kinds of operators");
    std::vector<Table> graphs;
    if (!model.tables(kSubgraphs, kMostTensors, [&](const Table& one) { graphs.push_back(one); }) ||
        graphs.size() != 1)
      return Error{Code::Unsupported, hc::format("{} graphs, not one", graphs.size())};
    HC_TRY(read_tensors(model, graphs[0]));
    HC_TRY(read_operators(graphs[0]));
    HC_TRY(read_ends(graphs[0]));
    if (!bytes_.is_sound()) return outside();
    return std::move(layers_);
  }

 private:
  [[nodiscard]] Error outside() const {
    return malformed(hc::format("it names places outside of its {} bytes", all_.size()));
  }

  Status read_tensors(const Table& model, const Table& graph) {
    std::vector<Vector> buffers;
    if (!model.tables(kBuffers, kMostTensors,
                      [&](const Table& buffer) { buffers.push_back(buffer.vector(kData)); }))
      return malformed("too many buffers");
    Status status;
    if (!graph.tables(kTensors, kMostTensors, [&](const Table& tensor) {
          if (status) status = read_tensor(tensor, buffers);
        }))
      return malformed("too many tensors");
    return status;
  }

  Status read_tensor(const Table& table, const std::vector<Vector>& buffers) {
    Tensor tensor{std::string(table.string(kTensorName).substr(0, 200)),
                  integers(table.vector(kShape), kMostExtents),
                  {},
                  {}};
    const auto type = static_cast<Type>(table.number<std::uint8_t>(kType));
    const auto buffer = table.number<std::uint32_t>(kBuffer);
    if (!bytes_.is_sound()) return outside();
    if (tensor.shape.size() > kMostExtents)
      return Error{Code::Unsupported,
                   hc::format("{} has more than {} extents", tensor.name, kMostExtents)};
    for (const int extent : tensor.shape)
      if (extent < 1) return malformed(hc::format("{} has an extent of {}", tensor.name, extent));
    HC_TRY(count(tensor));
    if (buffer >= buffers.size())
      return malformed(hc::format("{} is in buffer {} of {}", tensor.name, buffer, buffers.size()));
    if (buffers[buffer].size() > 0) HC_TRY(fill(tensor, type, buffers[buffer]));
    layers_.tensors.push_back(std::move(tensor));
    return {};
  }

  /// Bounds the memory of all tensors together.
  Status count(const Tensor& tensor) {
    long long size = 1;
    for (const int extent : tensor.shape) {
      size *= extent;
      if (size > kMostNumbers) break;
    }
    numbers_ += size;
    if (numbers_ <= kMostNumbers) return {};
    return Error{Code::TooLarge, hc::format("more than {} numbers", kMostNumbers)};
  }

  Status fill(Tensor& tensor, Type type, const Vector& buffer) {
    const auto size = static_cast<std::size_t>(size_of(tensor.shape));
    const std::size_t width = type == Type::Float16 ? 2 : 4;
    const auto bytes = buffer.bytes();
    if (!bytes_.is_sound()) return outside();
    if (bytes.size() != size * width)
      return malformed(
          hc::format("{} has {} bytes, not {}", tensor.name, bytes.size(), size * width));
    switch (type) {
      case Type::Float32:
        tensor.numbers.resize(size);
        std::memcpy(tensor.numbers.data(), bytes.data(), bytes.size());
        return {};
      case Type::Float16:
        tensor.numbers.resize(size);
        cv::Mat(1, static_cast<int>(size), CV_16F, const_cast<std::byte*>(bytes.data()))
            .convertTo(cv::Mat(1, static_cast<int>(size), CV_32F, tensor.numbers.data()), CV_32F);
        return {};
      case Type::Int32:
        tensor.integers.resize(size);
        std::memcpy(tensor.integers.data(), bytes.data(), bytes.size());
        return {};
    }
    return Error{Code::Unsupported,
                 hc::format("{} has numbers of type {}", tensor.name, static_cast<int>(type))};
  }

  Status read_operators(const Table& graph) {
    Status status;
    if (!graph.tables(kOperators, kMostTensors, [&](const Table& one) {
          if (status) status = read_operator(one);
        }))
      return malformed("too many operators");
    return status;
  }

  [[nodiscard]] bool is_tensor(int number) const {
    return number >= 0 && static_cast<std::size_t>(number) < layers_.tensors.size();
  }
  [[nodiscard]] Tensor& tensor(int number) {
    return layers_.tensors[static_cast<std::size_t>(number)];
  }

  Status read_operator(const Table& table) {
    const auto index = table.number<std::uint32_t>(kCodeIndex);
    auto inputs = integers(table.vector(kInputs), kMostEnds);
    const auto outputs = integers(table.vector(kOutputs), kMostEnds);
    if (!bytes_.is_sound()) return outside();
    if (index >= codes_.size())
      return malformed(hc::format("operator {} of {}", index, codes_.size()));
    const int code = codes_[index];
    while (!inputs.empty() && inputs.back() == -1) inputs.pop_back();  // no bias
    if (inputs.size() > kMostEnds)
      return Error{Code::Unsupported,
                   hc::format("an operator {} of more than {} inputs", code, kMostEnds)};
    if (inputs.empty() || outputs.size() != 1 || !is_tensor(outputs[0]) ||
        !std::all_of(inputs.begin(), inputs.end(), [&](int each) { return is_tensor(each); }))
      return malformed(hc::format("an operator {} without its tensors", code));
    if (code == kDequantize) {
      if (!tensor(inputs[0]).is_constant())
        return Error{Code::Unsupported, "numbers of 16 bits that are not constant"};
      if (tensor(inputs[0]).shape != tensor(outputs[0]).shape)
        return malformed("a constant changes its shape");
      tensor(outputs[0]).numbers = tensor(inputs[0]).numbers;
      return {};
    }
    const auto* known = std::find_if(std::begin(kKnown), std::end(kKnown),
                                     [&](const Known& each) { return each.code == code; });
    if (known == std::end(kKnown))
      return Error{Code::Unsupported, hc::format("TensorFlow Lite's operator {}", code)};
    Layer layer{known->kind, std::move(inputs), outputs[0]};
    HC_TRY(read_options(layer, table.table(kOptions)));
    layers_.layers.push_back(std::move(layer));
    return {};
  }

  Status read_options(Layer& layer, const Table& options) {
    // The fields' numbers differ from operator to operator.
    std::optional<std::size_t> activation, padding, strides, window;
    switch (layer.kind) {
      case Kind::Add:
      case Kind::FullyConnected:
        activation = 0;
        break;
      case Kind::Concatenation:
        layer.axis = options.number<std::int32_t>(0);
        activation = 1;
        break;
      case Kind::Convolution:
        padding = 0, strides = 1, activation = 3;
        break;
      case Kind::DepthwiseConvolution:
        padding = 0, strides = 1, activation = 4;
        break;
      case Kind::AveragePool:
      case Kind::MaxPool:
        padding = 0, strides = 1, window = 3, activation = 5;
        break;
      case Kind::ResizeBilinear:
        layer.align_corners = options.number<std::uint8_t>(2) != 0;
        layer.half_pixel_centers = options.number<std::uint8_t>(3) != 0;
        break;
      default:
        break;
    }
    if (padding) layer.is_padded = options.number<std::uint8_t>(*padding) == 0;
    if (strides) {
      layer.stride_right = options.number<std::int32_t>(*strides);
      layer.stride_down = options.number<std::int32_t>(*strides + 1);
    }
    if (window) {
      layer.window_width = options.number<std::int32_t>(*window);
      layer.window_height = options.number<std::int32_t>(*window + 1);
    }
    const std::size_t dilation = layer.kind == Kind::Convolution ? 4 : 5;
    if ((layer.kind == Kind::Convolution || layer.kind == Kind::DepthwiseConvolution) &&
        (options.number<std::int32_t>(dilation, 1) != 1 ||
         options.number<std::int32_t>(dilation + 1, 1) != 1))
      return Error{Code::Unsupported, "a convolution with gaps"};
    if (!activation) return {};
    switch (options.number<std::uint8_t>(*activation)) {
      case 0:
        return {};
      case 1:
        layer.activation = Kind::Relu;
        return {};
      case 3:
        layer.activation = Kind::Relu6;
        return {};
      default:
        return Error{Code::Unsupported, "an activation other than ReLU and ReLU6"};
    }
  }

  Status read_ends(const Table& graph) {
    const auto inputs = integers(graph.vector(kGraphInputs), kMostEnds);
    layers_.outputs = integers(graph.vector(kGraphOutputs), kMostEnds);
    if (!bytes_.is_sound()) return outside();
    if (inputs.size() != 1 || !is_tensor(inputs[0]))
      return Error{Code::Unsupported, hc::format("{} inputs, not one", inputs.size())};
    layers_.input = inputs[0];
    if (layers_.outputs.size() > kMostEnds)
      return Error{Code::Unsupported, hc::format("more than {} outputs", kMostEnds)};
    if (layers_.outputs.empty() || !std::all_of(layers_.outputs.begin(), layers_.outputs.end(),
                                                [&](int each) { return is_tensor(each); }))
      return malformed("no outputs");
    return {};
  }

  Bytes bytes_;
  std::span<const std::byte> all_;
  std::vector<int> codes_;
  Layers layers_;
  long long numbers_ = 0;
};

}  // namespace

std::string text(const Shape& shape) {
  std::string all;
  for (const int extent : shape) all += (all.empty() ? "" : "×") + std::to_string(extent);
  return all;
}

Result<Layers> read_tflite(std::span<const std::byte> bytes) {
  return Reader(bytes).read();
}

}  // namespace hc::nets
