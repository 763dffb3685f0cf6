// SPDX-License-Identifier: Apache-2.0
#include <vision/stereo/speckles.h>

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <utility>

namespace hc::vision {
namespace {

constexpr int kBandRows = 64;  // processed by one thread

}  // namespace

void SpeckleFilter::Patches::clear() {
  runs.clear();
  rows.assign(1, 0);
}

void SpeckleFilter::Patches::add_row(const std::uint16_t* row, int width, int range) {
  for (int x = 0; x < width;) {
    if (row[x] == 0) {
      ++x;
      continue;
    }
    const int begin = x++;
    while (x < width && row[x] != 0 && std::abs(row[x] - row[x - 1]) <= range) ++x;
    runs.push_back({begin, x, static_cast<std::uint32_t>(runs.size()), x - begin});
  }
  rows.push_back(static_cast<std::uint32_t>(runs.size()));
}

void SpeckleFilter::Patches::append(const Patches& below) {
  const auto first = static_cast<std::uint32_t>(runs.size());
  for (Run run : below.runs) {
    run.patch += first;
    runs.push_back(run);
  }
  for (std::size_t i = 1; i < below.rows.size(); ++i) rows.push_back(first + below.rows[i]);
}

void SpeckleFilter::Patches::join_rows(const cv::Mat& disparity, int y, std::size_t index,
                                       int range) {
  const auto *row = disparity.ptr<std::uint16_t>(y), *above = disparity.ptr<std::uint16_t>(y - 1);
  auto a = rows[index - 1], b = rows[index];
  while (a < rows[index] && b < rows[index + 1]) {
    const int begin = std::max(runs[a].begin, runs[b].begin);
    const int end = std::min(runs[a].end, runs[b].end);
    for (int x = begin; x < end; ++x) {
      if (std::abs(row[x] - above[x]) > range) continue;
      join(a, b);
      break;
    }
    ++(runs[a].end < runs[b].end ? a : b);
  }
}

std::uint32_t SpeckleFilter::Patches::patch_of(std::uint32_t run) const {
  while (runs[run].patch != run) run = runs[run].patch;
  return run;
}

void SpeckleFilter::Patches::join(std::uint32_t a, std::uint32_t b) {
  const auto first_of = [this](std::uint32_t run) {
    while (runs[run].patch != run) run = runs[run].patch = runs[runs[run].patch].patch;
    return run;
  };
  a = first_of(a);
  b = first_of(b);
  if (a == b) return;
  if (runs[a].pixels < runs[b].pixels) std::swap(a, b);
  runs[b].patch = a;
  runs[a].pixels += runs[b].pixels;
}

void SpeckleFilter::remove(cv::Mat& disparity, int min_size, int range) {
  const int count = (disparity.rows + kBandRows - 1) / kBandRows;
  bands_.resize(static_cast<std::size_t>(count));
  cv::parallel_for_({0, count}, [&](const cv::Range& bands) {
    for (int i = bands.start; i < bands.end; ++i) {
      Patches& band = bands_[static_cast<std::size_t>(i)];
      band.clear();
      const int first = i * kBandRows, end = std::min(first + kBandRows, disparity.rows);
      for (int y = first; y < end; ++y) {
        band.add_row(disparity.ptr<std::uint16_t>(y), disparity.cols, range);
        if (y > first) band.join_rows(disparity, y, static_cast<std::size_t>(y - first), range);
      }
    }
  });
  all_.clear();
  for (const Patches& band : bands_) all_.append(band);
  for (int y = kBandRows; y < disparity.rows; y += kBandRows)
    all_.join_rows(disparity, y, static_cast<std::size_t>(y), range);
  cv::parallel_for_({0, disparity.rows}, [&](const cv::Range& rows) {
    for (int y = rows.start; y < rows.end; ++y) {
      const auto index = static_cast<std::size_t>(y);
      for (auto run = all_.rows[index]; run < all_.rows[index + 1]; ++run)
        if (all_.runs[all_.patch_of(run)].pixels < min_size) {
          auto* row = disparity.ptr<std::uint16_t>(y);
          std::fill(row + all_.runs[run].begin, row + all_.runs[run].end, std::uint16_t{0});
        }
    }
  });
}

}  // namespace hc::vision
