// SPDX-License-Identifier: Apache-2.0
#pragma once
// Removes small patches of disparities, which are mostly wrong.

#include <cstdint>
#include <vector>

#include <opencv2/core.hpp>

namespace hc::vision {

/// Keeps its memory between images; for one thread at a time.
class SpeckleFilter {
 public:
  /// Clears the patches of fewer than `min_size` pixels. Two pixels that are one above or beside
  /// the other belong to one patch when both are known and differ by at most `range`.
  ///
  /// @param[in,out] disparity  (H, W) u16, 0 where unknown.
  /// Cost: linear in the pixels.
  void remove(cv::Mat& disparity, int min_size, int range);

 private:
  /// Pixels of a row that belong together.
  struct Run {
    int begin, end;       // columns
    std::uint32_t patch;  // a run of the same patch: itself for the one that stands for it
    std::int32_t pixels;  // of the patch, in the run that stands for it
  };

  std::uint32_t patch_of(std::uint32_t run);
  void join(std::uint32_t a, std::uint32_t b);

  std::vector<Run> runs_;
  std::vector<std::uint32_t> rows_;  // where the runs of a row begin
};

}  // namespace hc::vision
