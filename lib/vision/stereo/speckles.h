// SPDX-License-Identifier: Apache-2.0
#pragma once
// Removes small patches of disparities, which are mostly wrong.

#include <cstdint>
#include <vector>

#include <opencv2/core.hpp>

namespace hc::vision {

/// Reuses its memory; not thread-safe, but uses all cores.
class SpeckleFilter {
 public:
  /// Clears the patches of fewer than `min_size` pixels. Two neighbours (above or beside) belong to
  /// one patch if both are known and differ by at most `range`.
  ///
  /// @param[in,out] disparity  (H, W) u16, 0 where unknown.
  /// Cost: linear in the pixels.
  void remove(cv::Mat& disparity, int min_size, int range);

 private:
  /// Adjacent pixels of a row in the same patch.
  struct Run {
    int begin, end;       // columns
    std::uint32_t patch;  // another run of the patch, or itself for the first one
    std::int32_t pixels;  // of the patch, in its first run
  };

  /// The patches of some rows.
  struct Patches {
    std::vector<Run> runs;
    std::vector<std::uint32_t> rows;  // first run of each row, then the end of the last row

    void clear();
    void add_row(const std::uint16_t* row, int width, int range);
    void append(const Patches& below);
    /// Joins the patches of the row at `index` with those of the row above it.
    void join_rows(const cv::Mat& disparity, int y, std::size_t index, int range);
    std::uint32_t patch_of(std::uint32_t run) const;

   private:
    void join(std::uint32_t a, std::uint32_t b);
  };

  std::vector<Patches> bands_;
  Patches all_;
};

}  // namespace hc::vision
