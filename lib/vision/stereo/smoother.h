// SPDX-License-Identifier: Apache-2.0
#pragma once
// Smooths disparities and preserves edges.
//
// Source: Lee, Digital Image Smoothing and the Sigma Filter, 1983.

#include <cstddef>
#include <cstdint>

#include <opencv2/core.hpp>

namespace hc::vision {

/// Reuses its memory; not thread-safe.
class Smoother {
 public:
  static constexpr int kReach = 4;   ///< to either side [px]
  static constexpr int kRange = 96;  ///< larger differences mean another surface [1/64 px]

  /// Replaces each known disparity by the mean of the nearby ones that differ by at most kRange,
  /// along rows and then along columns.
  ///
  /// @param disparity  (H, W) u16 [1/64 px], at most 2¹⁴; 0 where unknown.
  /// @param[out] smooth  (H, W) u16; 0 where unknown. The result is the same on every processor and
  ///     with any number of threads.
  void smooth(const cv::Mat& disparity, cv::Mat& smooth);

 private:
  cv::Mat rows_, columns_;
};

/// One direction of smooth(), for `count` disparities from `from` on; the neighbours of each are up
/// to kReach times `step` before and behind it.
void mean_along(const std::uint16_t* from, std::ptrdiff_t step, int count, std::uint16_t* to);

}  // namespace hc::vision
