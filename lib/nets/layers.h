// SPDX-License-Identifier: Apache-2.0
#pragma once
// The layers of a neural network, as read from a file of weights. Pure.

#include <optional>
#include <string>
#include <vector>

namespace hc::nets {

/// Extents, of images (1, height, width, channels).
using Shape = std::vector<int>;

/// An array of numbers: a constant of the file, or what a layer computes.
struct Tensor {
  std::string name;
  Shape shape;                 ///< each extent ≥ 1
  std::vector<float> numbers;  ///< of a constant, row-major; else empty
  std::vector<int> integers;   ///< of a constant of integers, such as the extents of a padding
  [[nodiscard]] bool is_constant() const { return !numbers.empty() || !integers.empty(); }
};

enum class Kind {
  Add,
  AveragePool,
  Concatenation,
  Convolution,           ///< weights (out, height, width, in)
  DepthwiseConvolution,  ///< weights (1, height, width, channels)
  FullyConnected,        ///< weights (out, in)
  Logistic,
  MaxPool,
  Mean,  ///< of all pixels, for each channel
  Pad,
  Prelu,
  Relu,
  Relu6,
  Reshape,
  ResizeBilinear,
};

/// One layer. Tensors are given by their numbers in Layers::tensors.
struct Layer {
  Kind kind = Kind::Add;
  std::vector<int> inputs;  ///< with weights and bias, in TensorFlow Lite's order
  int output = 0;
  std::optional<Kind> activation = std::nullopt;  ///< Relu or Relu6
  bool is_padded = false;  ///< SAME: a window at each stride; otherwise VALID
  int window_height = 1, window_width = 1, stride_down = 1, stride_right = 1;
  int axis = 0;                                            ///< of a concatenation
  bool align_corners = false, half_pixel_centers = false;  ///< of a resize
};

/// A network of one image: in the order in which it is computed.
struct Layers {
  std::vector<Tensor> tensors;
  std::vector<Layer> layers;
  int input = 0;
  std::vector<int> outputs;
};

/// Maximum number of numbers in all constants, in all results of layers, in all weights of layers,
/// which may share constants, and in an image with its padding.
inline constexpr long long kMostNumbers = 1LL << 26;

/// The number of elements.
inline long long size_of(const Shape& shape) {
  long long size = 1;
  for (const int extent : shape) size *= extent;
  return size;
}

/// "1×64×64×24"
std::string text(const Shape& shape);

}  // namespace hc::nets
