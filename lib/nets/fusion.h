// SPDX-License-Identifier: Apache-2.0
#pragma once
// Layers that are fused into the convolution before them. Pure.

#include <cstddef>
#include <optional>
#include <vector>

#include <nets/layers.h>

namespace hc::nets {

/// A convolution with the layers after it that can be computed with it, since nothing else uses
/// what they compute in between.
struct Fused {
  std::optional<int> addend;        ///< the tensor that is added to its result
  std::optional<Kind> activation;   ///< Relu, Relu6 or Prelu, after that
  std::optional<int> slopes;        ///< of Prelu, a constant
  int output = 0;                   ///< the tensor that results
  std::vector<std::size_t> layers;  ///< the others, in Layers::layers
};

/// Finds the layers of a network that can be fused.
class Fusion {
 public:
  /// @param layers  whose shapes are right (check_shapes()), and which live longer.
  explicit Fusion(const Layers& layers);
  /// @param convolution  its number in Layers::layers.
  [[nodiscard]] Fused of(std::size_t convolution) const;

 private:
  struct Uses {
    std::size_t count = 0, last = 0;  // the layer that uses it last
  };
  /// The only layer that uses a tensor, if there is one.
  [[nodiscard]] std::optional<std::size_t> only_use(int tensor) const;

  const Layers& layers_;
  // For each tensor.
  std::vector<Uses> uses_;
  std::vector<std::size_t> ready_;  // the first layer that can use it
};

}  // namespace hc::nets
