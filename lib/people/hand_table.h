// SPDX-License-Identifier: Apache-2.0
#pragma once
// The rows of the table `hands` of module hands. Pure.

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <people/hand.h>
#include <people/sign.h>

namespace hc::people {

/// A hand of a row.
struct HandRow {
  int track = 0;  ///< from 1
  Hand::Side side = Hand::Side::Right;
  float presence = 0;  ///< 0 … 1
  Sign sign = Sign::None;
  std::array<cv::Point2f, Hand::kPoints> points;  ///< [px]
};

inline constexpr std::int32_t kHandColumns = 4 + 2 * static_cast<std::int32_t>(Hand::kPoints);
/// Their names, with units.
std::vector<std::string> hand_columns();

/// @param[out] row  of kHandColumns numbers.
void write(const HandRow& hand, std::span<double> row);
/// The hand of a row; nothing if it has too few numbers, or some that no hand has: NaN, a sign that
/// there is not.
std::optional<HandRow> hand_in(std::span<const double> row);

}  // namespace hc::people
