// SPDX-License-Identifier: Apache-2.0
#pragma once
// Layers that can be computed together with the convolution before them. Pure.

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include <nets/layers.h>

namespace hc::nets {

/// What is computed together with a convolution, since nothing else uses its own result.
struct Tail {
  std::optional<int> plus;        ///< the tensor that is added
  std::optional<Kind> activation; ///< Relu, Relu6 or Prelu, after that
  std::optional<int> slopes;      ///< of Prelu, a constant
  int output = 0;                 ///< the tensor that results
  std::vector<std::size_t> layers;  ///< that are computed by this, in Layers::layers
};

/// Finds the tails in a network.
class Tails {
 public:
  /// @param layers  whose shapes are right, and which live longer.
  explicit Tails(const Layers& layers);
  /// The tail of a convolution. @param is_computed  whether a tensor is computed before it.
  [[nodiscard]] Tail after(const Layer& convolution,
                           const std::function<bool(int tensor)>& is_computed) const;

 private:
  /// The only layer that uses a tensor, if there is one.
  [[nodiscard]] std::optional<std::size_t> only_use(int tensor) const;

  const Layers& layers_;
  std::vector<std::vector<std::size_t>> uses_;  // the layers, for each tensor
};

}  // namespace hc::nets
