// SPDX-License-Identifier: Apache-2.0
#pragma once
// Evens out what a matcher finds on surfaces, and keeps edges.
//
// Source: Lee, Digital Image Smoothing and the Sigma Filter, 1983.

#include <cstddef>
#include <cstdint>

#include <opencv2/core.hpp>

namespace hc::vision {

/// Keeps its memory between images; for one thread at a time.
class Smoother {
 public:
  static constexpr int kReach = 4;   ///< to either side [px]
  static constexpr int kRange = 96;  ///< other disparities are of another surface [1/64 px]

  /// Replaces each known disparity by the mean of those near it that differ by at most kRange,
  /// along rows and then along columns.
  ///
  /// @param disparity  (H, W) u16 [1/64 px], at most 2¹⁴; 0 where unknown.
  /// @param[out] smooth  (H, W) u16; unknown where `disparity` is.
  /// The same on every processor and with any number of threads.
  void smooth(const cv::Mat& disparity, cv::Mat& smooth);

 private:
  cv::Mat rows_, columns_;
};

/// A means of that, for the two directions: of `count` disparities that begin at `from`, with
/// others kReach times `step` before and behind each.
void mean_along(const std::uint16_t* from, std::ptrdiff_t step, int count, std::uint16_t* to);

}  // namespace hc::vision
