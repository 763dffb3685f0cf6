// SPDX-License-Identifier: Apache-2.0
#include <people/hand_table.h>

#include <cstddef>

#include <hc/base/check.h>
#include <people/short_number.h>
#include <people/table_row.h>

namespace hc::people {
namespace {

/// The columns of its numbers.
struct HandAt {
  static constexpr std::size_t kTrack = 0, kSide = 1, kPresence = 2, kSign = 3, kPoints = 4;
};

}  // namespace

std::vector<std::string> hand_columns() {
  std::vector<std::string> columns{"track", "side", "presence", "sign"};
  std::vector<std::string> points{"wrist"};
  for (const auto* part : {"base", "knuckle", "joint", "tip"})
    points.push_back(std::string("thumb ") + part);
  for (const auto* finger : {"index", "middle", "ring", "little"})
    for (const auto* part : {"knuckle", "joint", "last joint", "tip"})
      points.push_back(std::string(finger) + " " + part);
  for (const auto& point : points)
    for (const auto* axis : {" x [px]", " y [px]"}) columns.push_back(point + axis);
  return columns;
}

void write(const HandRow& hand, std::span<double> row) {
  HC_CHECK(row.size() == static_cast<std::size_t>(kHandColumns), row.size());
  auto to = row.begin();
  *to++ = hand.track;
  *to++ = hand.side == Hand::Side::Right ? 1 : 0;
  *to++ = short_number(hand.presence);
  *to++ = static_cast<double>(hand.sign);
  for (const auto& point : hand.points) {
    *to++ = short_pixel(point.x);
    *to++ = short_pixel(point.y);
  }
}

std::optional<HandRow> hand_in(std::span<const double> row) {
  if (!is_row(row, kHandColumns) || !is_count(row[HandAt::kTrack], 1) ||
      !is_count(row[HandAt::kSign], 0) || row[HandAt::kSign] > static_cast<double>(Sign::ThumbUp))
    return std::nullopt;
  if ((row[HandAt::kSide] != 0 && row[HandAt::kSide] != 1) ||
      !(row[HandAt::kPresence] >= 0 && row[HandAt::kPresence] <= 1))
    return std::nullopt;
  HandRow hand;
  hand.track = static_cast<int>(row[HandAt::kTrack]);
  hand.side = row[HandAt::kSide] == 1 ? Hand::Side::Right : Hand::Side::Left;
  hand.presence = static_cast<float>(row[HandAt::kPresence]);
  hand.sign = static_cast<Sign>(row[HandAt::kSign]);
  for (std::size_t i = 0; i < hand.points.size(); ++i)
    hand.points[i] = pixel_of(row, HandAt::kPoints + 2 * i);
  return hand;
}

}  // namespace hc::people
