// SPDX-License-Identifier: Apache-2.0
#include <nets/face_api.h>

#include <cstring>
#include <map>
#include <string>
#include <utility>

#include <nlohmann/json.hpp>

#include <hc/base/format.h>

namespace hc::nets {
namespace {

using Json = nlohmann::json;

constexpr int kSide = 150;  // of the face chip [px]

/// The constants of the file.
class Constants {
 public:
  static Result<Constants> read(std::string_view manifest, std::span<const std::byte> bytes) {
    Constants constants;
    std::size_t at = 0;
    try {
      const Json all = Json::parse(manifest);
      for (const Json& each : all.at(0).at("weights")) {
        Tensor tensor{each.at("name"), {}, {}, {}};
        const bool is_short = each.contains("quantization");
        const std::string type = is_short ? each.at("quantization").at("dtype") : each.at("dtype");
        if (type != (is_short ? "uint8" : "float32"))
          return Error{Code::Unsupported,
                       hc::format("{} has numbers of type {}", tensor.name, type)};
        std::size_t size = is_short ? 1 : sizeof(float);
        for (const Json& extent : each.at("shape")) {
          const auto side = extent.is_number_integer() ? extent.get<long long>() : 0;
          if (side < 1 || side > kMostNumbers)
            return malformed(tensor.name + " has an extent that is no size");
          tensor.shape.push_back(static_cast<int>(side));
          size *= static_cast<std::size_t>(side);
          if (size > bytes.size()) break;
        }
        if (size > bytes.size() - at)
          return malformed(
              hc::format("it ends before {}, after {} bytes", tensor.name, bytes.size()));
        const auto part = bytes.subspan(at, size);
        if (is_short) {
          const float scale = each.at("quantization").at("scale");
          const float least = each.at("quantization").at("min");
          for (const std::byte byte : part)
            tensor.numbers.push_back(static_cast<float>(byte) * scale + least);
        } else {
          tensor.numbers.resize(size / sizeof(float));
          std::memcpy(tensor.numbers.data(), part.data(), size);
        }
        at += size;
        std::string name = tensor.name;
        if (!constants.tensors_.try_emplace(name, std::move(tensor)).second)
          return malformed(hc::format("it has {} twice", name));
      }
    } catch (const Json::exception& failed) {
      return malformed(hc::format("its manifest: {}", failed.what()));
    }
    if (at != bytes.size()) return malformed(hc::format("{} bytes too many", bytes.size() - at));
    return constants;
  }

  [[nodiscard]] Result<Tensor> take(const std::string& name, const Shape& shape) {
    auto found = tensors_.extract(name);
    if (found.empty()) return malformed("it has no " + name);
    if (found.mapped().shape != shape)
      return malformed(
          hc::format("{} is {}, not {}", name, text(found.mapped().shape), text(shape)));
    return std::move(found.mapped());
  }

 private:
  static Error malformed(const std::string& what) { return {Code::Malformed, what}; }

  std::map<std::string, Tensor> tensors_;
};

/// Adds layer after layer.
class Recogniser {
 public:
  explicit Recogniser(Constants constants) : constants_(std::move(constants)) {}

  Result<Layers> build() {
    int image = add({"image", {1, kSide, kSide, 3}, {}, {}});
    layers_.input = image;
    image = HC_TRY(convolution(image, "conv32_down", 7, 32, 2, true));
    image = pool(image, Kind::MaxPool, 3, 2);
    for (const char* name : {"conv32_1", "conv32_2", "conv32_3"})
      image = HC_TRY(block(image, name, 32, 1));
    image = HC_TRY(block(image, "conv64_down", 64, 2));
    for (const char* name : {"conv64_1", "conv64_2", "conv64_3"})
      image = HC_TRY(block(image, name, 64, 1));
    image = HC_TRY(block(image, "conv128_down", 128, 2));
    for (const char* name : {"conv128_1", "conv128_2"}) image = HC_TRY(block(image, name, 128, 1));
    image = HC_TRY(block(image, "conv256_down", 256, 2));
    for (const char* name : {"conv256_1", "conv256_2"}) image = HC_TRY(block(image, name, 256, 1));
    image = HC_TRY(block(image, "conv256_down_out", 256, 2));
    image = put({Kind::Mean, {image, axes()}}, {1, shape(image)[3]});
    const int numbers = HC_TRY(connections(image));
    layers_.outputs = {numbers};
    return std::move(layers_);
  }

 private:
  int add(Tensor tensor) {
    layers_.tensors.push_back(std::move(tensor));
    return static_cast<int>(layers_.tensors.size()) - 1;
  }
  [[nodiscard]] const Shape& shape(int number) const {
    return layers_.tensors[static_cast<std::size_t>(number)].shape;
  }
  int put(Layer layer, Shape made) {
    layer.output = add({hc::format("layer {}", layers_.layers.size()), std::move(made), {}, {}});
    layers_.layers.push_back(std::move(layer));
    return layers_.layers.back().output;
  }
  int axes() { return add({"axes", {2}, {}, {1, 2}}); }

  static int steps(int side, int window, int stride) { return (side - window) / stride + 1; }

  int pool(int from, Kind kind, int window, int stride) {
    Layer layer{kind, {from}};
    layer.window_height = layer.window_width = window;
    layer.stride_down = layer.stride_right = stride;
    const Shape of = shape(from);
    return put(layer, {1, steps(of[1], window, stride), steps(of[2], window, stride), of[3]});
  }

  /// A convolution whose results are scaled, which is done to its weights.
  Result<int> convolution(int from, const std::string& name, int window, int out, int stride,
                          bool is_positive) {
    const Shape of = shape(from);
    const int in = of[3];
    const auto filters = HC_TRY(constants_.take(name + "/conv/filters", {window, window, in, out}));
    const auto bias = HC_TRY(constants_.take(name + "/conv/bias", {out}));
    const auto scale = HC_TRY(constants_.take(name + "/scale/weights", {out}));
    const auto shift = HC_TRY(constants_.take(name + "/scale/biases", {out}));
    Tensor weights{name, {out, window, window, in}, {}, {}}, biases{name + " bias", {out}, {}, {}};
    const std::size_t outs = static_cast<std::size_t>(out), each = filters.numbers.size() / outs;
    for (std::size_t o = 0; o < outs; ++o) {
      for (std::size_t i = 0; i < each; ++i)
        weights.numbers.push_back(filters.numbers[i * outs + o] * scale.numbers[o]);
      biases.numbers.push_back(bias.numbers[o] * scale.numbers[o] + shift.numbers[o]);
    }
    Layer layer{Kind::Convolution, {from, add(std::move(weights)), add(std::move(biases))}};
    if (is_positive) layer.activation = Kind::Relu;
    layer.stride_down = layer.stride_right = stride;
    layer.is_padded = stride == 1;
    if (stride == 1) return put(layer, {1, of[1], of[2], out});
    return put(layer, {1, steps(of[1], window, stride), steps(of[2], window, stride), out});
  }

  int pad(int from, int rows, int columns, int channels) {
    if (rows == 0 && columns == 0 && channels == 0) return from;
    const Shape of = shape(from);
    const int by = add({"padding", {4, 2}, {}, {0, 0, 0, rows, 0, columns, 0, channels}});
    return put({Kind::Pad, {from, by}}, {1, of[1] + rows, of[2] + columns, of[3] + channels});
  }

  /// Two convolutions, to which their input is added; with a stride of 2, its averages, and zeros
  /// where one is smaller than the other.
  Result<int> block(int from, const std::string& name, int out, int stride) {
    int made = HC_TRY(convolution(from, name + "/conv1", 3, out, stride, true));
    made = HC_TRY(convolution(made, name + "/conv2", 3, out, 1, false));
    if (stride > 1) {
      from = pool(from, Kind::AveragePool, 2, 2);
      made = pad(made, shape(from)[1] - shape(made)[1], shape(from)[2] - shape(made)[2], 0);
      from = pad(from, 0, 0, out - shape(from)[3]);
    }
    Layer sum{Kind::Add, {from, made}};
    sum.activation = Kind::Relu;
    return put(sum, shape(made));
  }

  Result<int> connections(int from) {
    constexpr int kNumbers = 128;
    const int in = shape(from)[1];
    const auto found = HC_TRY(constants_.take("fc", {in, kNumbers}));
    Tensor weights{"fc", {kNumbers, in}, {}, {}};
    for (std::size_t o = 0; o < kNumbers; ++o)
      for (std::size_t i = 0; i < static_cast<std::size_t>(in); ++i)
        weights.numbers.push_back(found.numbers[i * kNumbers + o]);
    return put({Kind::FullyConnected, {from, add(std::move(weights))}}, {1, kNumbers});
  }

  Constants constants_;
  Layers layers_;
};

}  // namespace

Result<Layers> read_face_recognition(std::string_view manifest,
                                     std::span<const std::byte> weights) {
  auto constants = HC_TRY(Constants::read(manifest, weights));
  return Recogniser(std::move(constants)).build();
}

}  // namespace hc::nets
