// SPDX-License-Identifier: Apache-2.0
#include <graphics/occlusion.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace hc::graphics {
namespace {

/// Neighbours that differ by less belong to one surface [px].
constexpr float kSurface = 1.5F;

/// A row of nearness; only columns from `begin` to `end` are used [px].
struct Row {
  std::vector<float> nearness;
  std::size_t begin = 0, end = nearness.size();
};

void invert(const float* depth, float scale, Row& row) {
  const auto most = static_cast<float>(row.nearness.size());  // nearer: outside the right image
  for (std::size_t x = row.begin; x < row.end; ++x)
    row.nearness[x] = depth[x] > 0 ? std::min(scale / depth[x], most) : 0;
}

/// Moves each pixel to its position in the right eye; the nearest wins.
void move_right(const Row& left, Row& right) {
  std::fill(right.nearness.begin(), right.nearness.end(), 0.0F);
  const auto put = [&](float u, float nearness) {
    auto& there = right.nearness[static_cast<std::size_t>(u)];  // rounded down
    there = std::max(there, nearness);
  };
  for (std::size_t x = left.begin; x < left.end; ++x) {
    const float here = left.nearness[x];
    const float u = static_cast<float>(x) - here;
    if (here == 0 || u < 0) continue;
    put(u + 0.5F, here);
    if (x + 1 == left.end) continue;
    // Fill the gap if the surface is stretched.
    const float next = left.nearness[x + 1];
    if (next != 0 && std::abs(next - here) < kSurface) put(u + 1, std::min(here, next));
  }
}

void fill_holes(Row& row) {
  const auto at = [&](std::size_t x) {
    return row.nearness.begin() + static_cast<std::ptrdiff_t>(x);
  };
  float before = 0;
  std::size_t begin = row.begin;  // of the hole
  for (std::size_t x = row.begin; x < row.end; ++x) {
    const float here = row.nearness[x];
    if (here == 0) continue;
    std::fill(at(begin), at(x), before == 0 ? here : std::min(before, here));
    before = here;
    begin = x + 1;
  }
  std::fill(at(begin), at(row.end), before);
}

/// The left eye's nearness from `begin` to `end`, extended to the ends of holes at both sides.
void see_left(const float* depth, float scale, std::size_t begin, std::size_t end, Row& row) {
  while (begin > 0 && !(depth[begin] > 0)) --begin;
  while (end < row.nearness.size() && !(depth[end - 1] > 0)) ++end;
  row.begin = begin;
  row.end = end;
  invert(depth, scale, row);
  fill_holes(row);
}

/// The right eye's nearness from `begin`. It depends on columns further right and the previous one;
/// on all only if a hole starts further left.
void see_right(const float* depth, float scale, std::size_t begin, Row& left, Row& right) {
  left.begin = begin - std::min<std::size_t>(begin, 1);
  right.begin = begin;
  invert(depth, scale, left);
  move_right(left, right);
  if (right.nearness[begin] == 0 && begin > 0) return see_right(depth, scale, 0, left, right);
  fill_holes(right);
}

}  // namespace

void nearness_of(bool is_right, const cv::Mat& depth, double scale, const cv::Rect& part,
                 cv::Mat& nearness) {
  nearness.create(part.size(), CV_32F);
  const auto begin = static_cast<std::size_t>(part.x);
  const auto end = begin + static_cast<std::size_t>(part.width);
  cv::parallel_for_({0, part.height}, [&](const cv::Range& rows) {
    Row left{std::vector<float>(static_cast<std::size_t>(depth.cols))}, right = left;
    for (int y = rows.start; y < rows.end; ++y) {
      const auto* from = depth.ptr<float>(part.y + y);
      if (is_right)
        see_right(from, static_cast<float>(scale), begin, left, right);
      else
        see_left(from, static_cast<float>(scale), begin, end, left);
      const auto& row = is_right ? right : left;
      std::copy_n(row.nearness.begin() + part.x, part.width, nearness.ptr<float>(y));
    }
  });
}

}  // namespace hc::graphics
