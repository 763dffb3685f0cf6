// SPDX-License-Identifier: Apache-2.0
#pragma once
// The numbered coordinate systems (spec/mtp-1.md, R44). Pure.

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace hc {

/// A coordinate system of the specification, as in a header's `coord`.
///
///     auto gaze = module.output("gaze", hc::rotation().of(1, 1).in(hc::Coord::kGaze), "…");
///     if (message.header.coord == hc::Coord::kLeftImage) …
struct Coord {
  static constexpr std::int32_t kWorld = 1, kRobot = 2, kHead = 3;
  static constexpr std::int32_t kLeftEye = 4, kRightEye = 5, kCyclopeanEye = 6;
  static constexpr std::int32_t kLeftImage = 7, kRightImage = 8;
  static constexpr std::int32_t kLeftRectified = 9, kRightRectified = 10;
  static constexpr std::int32_t kDepth = 11, kDisparity = 12;
  static constexpr std::int32_t kGaze = 13, kSupervisor = 14;
  static constexpr std::int32_t kRightDepth = 15;
  static constexpr std::int32_t kSound8k = 20, kSound16k = 21, kSound22k = 22, kSound44k = 23,
                                kSound48k = 24;
  static constexpr std::int32_t kText = 30, kOrder = 40;

  std::int32_t number = 0;
  std::string_view name;
  std::string_view doc;   ///< unit and structure
  bool is_frame = false;  ///< a metric frame, for positions and poses
};

/// All coordinate systems, ordered by number.
std::span<const Coord> coords();

/// The coordinate system with a number or name; null if there is none.
const Coord* find_coord(std::int32_t number);
const Coord* find_coord(std::string_view name);

/// The coord of a transformation of points from one frame to another, 1000 · to + from.
constexpr std::int32_t transform_coord(std::int32_t to, std::int32_t from) {
  return 1000 * to + from;
}

/// A readable `coord`: "gaze", "world from head", "123".
std::string coord_text(std::int32_t coord);
/// Also with the number: "gaze (13)", "123".
std::string coord_and_number(std::int32_t coord);

}  // namespace hc
