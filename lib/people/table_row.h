// SPDX-License-Identifier: Apache-2.0
#pragma once
// What the rows of the tables of faces and hands have in common. Pure. Internal.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

#include <opencv2/core/types.hpp>

namespace hc::people {

/// Largest magnitude in a row: an int holds it.
inline constexpr double kMostInRow = 1e9;

/// Whether a row has so many numbers, none of which is NaN, infinite or too large.
inline bool is_row(std::span<const double> row, std::int32_t columns) {
  return row.size() >= static_cast<std::size_t>(columns) &&
         std::ranges::all_of(row, [](double each) { return std::abs(each) <= kMostInRow; });
}
/// Whether a number is a whole one, not below `least`.
inline bool is_count(double number, double least) {
  return number >= least && number == std::floor(number);
}
inline cv::Point2f pixel_of(std::span<const double> row, std::size_t column) {
  return {static_cast<float>(row[column]), static_cast<float>(row[column + 1])};
}

}  // namespace hc::people
