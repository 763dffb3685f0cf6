// SPDX-License-Identifier: Apache-2.0
#include <people/hand_table.h>

#include <cstddef>

#include <hc/base/table_row.h>

namespace hc::people {
namespace {

/// The names of the columns of the points.
std::vector<std::string> point_names() {
  std::vector<std::string> points{"wrist"};
  for (const auto* part : {"base", "knuckle", "joint", "tip"})
    points.push_back(std::string("thumb ") + part);
  for (const auto* finger : {"index", "middle", "ring", "little"})
    for (const auto* part : {"knuckle", "joint", "last joint", "tip"})
      points.push_back(std::string(finger) + " " + part);
  std::vector<std::string> names;
  for (const auto& point : points)
    for (const auto* axis : {" x", " y"}) names.push_back(point + axis);
  return names;
}

struct HandColumns {
  static void visit(auto& hand, auto&& column) {
    static const auto kNames = point_names();
    column("track", "", hand.track, 1.0);
    column("side", "", hand.side, 0.0, 1.0);
    column("presence", "", hand.presence, 0.0, 1.0);
    column("sign", "", hand.sign, 0.0, static_cast<double>(Sign::ThumbUp));
    for (std::size_t i = 0; i < Hand::kPoints; ++i) {
      column(kNames[2 * i], "px", hand.points[i].x);
      column(kNames[2 * i + 1], "px", hand.points[i].y);
    }
  }
};

}  // namespace

std::vector<std::string> hand_columns() {
  return column_names<HandColumns, HandRow>();
}

void write(const HandRow& hand, std::span<double> row) {
  write_row<HandColumns>(hand, row);
}

std::optional<HandRow> hand_in(std::span<const double> row) {
  return read_row<HandColumns, HandRow>(row);
}

}  // namespace hc::people
