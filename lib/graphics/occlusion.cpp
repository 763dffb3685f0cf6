// SPDX-License-Identifier: Apache-2.0
#include <graphics/occlusion.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace hc::graphics {
namespace {

/// Two neighbours are of one surface if they differ by less [px].
constexpr float kSurface = 1.5F;

void invert(const float* depth, float scale, std::vector<float>& row) {
  const auto most = static_cast<float>(row.size());  // what is nearer is outside the right image
  for (std::size_t x = 0; x < row.size(); ++x)
    row[x] = depth[x] > 0 ? std::min(scale / depth[x], most) : 0;
}

/// Moves each pixel to where the right eye sees it; the nearest stays.
void move_right(const std::vector<float>& left, std::vector<float>& right) {
  std::fill(right.begin(), right.end(), 0.0F);
  const auto put = [&](float u, float nearness) {
    auto& there = right[static_cast<std::size_t>(u)];  // rounded down
    there = std::max(there, nearness);
  };
  for (std::size_t x = 0; x < left.size(); ++x) {
    const float here = left[x];
    const float u = static_cast<float>(x) - here;
    if (here == 0 || u < 0) continue;
    put(u + 0.5F, here);
    if (x + 1 == left.size()) continue;
    // What is stretched leaves no gap between two pixels.
    const float next = left[x + 1];
    if (next != 0 && std::abs(next - here) < kSurface) put(u + 1, std::min(here, next));
  }
}

void fill_holes(std::vector<float>& row) {
  float before = 0;
  std::size_t begin = 0;  // of the hole
  for (std::size_t x = 0; x < row.size(); ++x) {
    if (row[x] == 0) continue;
    std::fill(row.begin() + static_cast<std::ptrdiff_t>(begin),
              row.begin() + static_cast<std::ptrdiff_t>(x),
              before == 0 ? row[x] : std::min(before, row[x]));
    before = row[x];
    begin = x + 1;
  }
  std::fill(row.begin() + static_cast<std::ptrdiff_t>(begin), row.end(), before);
}

void nearness_of(const cv::Mat& depth, double scale, const cv::Rect& part, bool is_right,
                 cv::Mat& nearness) {
  nearness.create(part.size(), CV_32F);
  cv::parallel_for_({0, part.height}, [&](const cv::Range& rows) {
    std::vector<float> left(static_cast<std::size_t>(depth.cols)), right(left.size());
    for (int y = rows.start; y < rows.end; ++y) {
      invert(depth.ptr<float>(part.y + y), static_cast<float>(scale), left);
      if (is_right) move_right(left, right);
      auto& row = is_right ? right : left;
      fill_holes(row);
      std::copy_n(row.begin() + part.x, part.width, nearness.ptr<float>(y));
    }
  });
}

}  // namespace

void nearness_of_left(const cv::Mat& depth, double scale, const cv::Rect& part, cv::Mat& nearness) {
  nearness_of(depth, scale, part, false, nearness);
}

void nearness_of_right(const cv::Mat& depth, double scale, const cv::Rect& part,
                       cv::Mat& nearness) {
  nearness_of(depth, scale, part, true, nearness);
}

}  // namespace hc::graphics
