// SPDX-License-Identifier: Apache-2.0
#include <vision/stereo/speckles.h>

#include <algorithm>
#include <cstdlib>
#include <utility>

namespace hc::vision {

std::uint32_t SpeckleFilter::patch_of(std::uint32_t run) {
  while (runs_[run].patch != run) {
    runs_[run].patch = runs_[runs_[run].patch].patch;
    run = runs_[run].patch;
  }
  return run;
}

void SpeckleFilter::join(std::uint32_t a, std::uint32_t b) {
  a = patch_of(a);
  b = patch_of(b);
  if (a == b) return;
  if (runs_[a].pixels < runs_[b].pixels) std::swap(a, b);
  runs_[b].patch = a;
  runs_[a].pixels += runs_[b].pixels;
}

void SpeckleFilter::remove(cv::Mat& disparity, int min_size, int range) {
  runs_.clear();
  rows_.assign(1, 0);
  for (int y = 0; y < disparity.rows; ++y) {
    const auto* row = disparity.ptr<std::uint16_t>(y);
    for (int x = 0; x < disparity.cols;) {
      if (row[x] == 0) {
        ++x;
        continue;
      }
      const int begin = x++;
      while (x < disparity.cols && row[x] != 0 && std::abs(row[x] - row[x - 1]) <= range) ++x;
      const auto index = static_cast<std::uint32_t>(runs_.size());
      runs_.push_back({begin, x, index, x - begin});
    }
    rows_.push_back(static_cast<std::uint32_t>(runs_.size()));
    if (y == 0) continue;
    const auto* above = disparity.ptr<std::uint16_t>(y - 1);
    const auto at = static_cast<std::size_t>(y);
    auto a = rows_[at - 1], b = rows_[at];
    while (a < rows_[at] && b < rows_[at + 1]) {
      const int begin = std::max(runs_[a].begin, runs_[b].begin);
      const int end = std::min(runs_[a].end, runs_[b].end);
      for (int x = begin; x < end; ++x) {
        if (std::abs(row[x] - above[x]) > range) continue;
        join(a, b);
        break;
      }
      ++(runs_[a].end < runs_[b].end ? a : b);
    }
  }
  for (int y = 0; y < disparity.rows; ++y) {
    auto* row = disparity.ptr<std::uint16_t>(y);
    for (auto run = rows_[static_cast<std::size_t>(y)];
         run < rows_[static_cast<std::size_t>(y) + 1]; ++run)
      if (runs_[patch_of(run)].pixels < min_size)
        std::fill(row + runs_[run].begin, row + runs_[run].end, std::uint16_t{0});
  }
}

}  // namespace hc::vision
