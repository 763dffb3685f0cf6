// SPDX-License-Identifier: Apache-2.0
#include <room/markers.h>

#include <cmath>
#include <string_view>

#include <room/paint.h>
#include <room/room.h>

namespace hc::room {

namespace {

using Eigen::Isometry3d;
using Eigen::Translation3d;
using Eigen::Vector3d;
using graphics::make_box;
using graphics::make_rectangle;

struct Placement {
  const char* kind;
  int id;
  double side;
  Vector3d place;
  double yaw;
};

/// The image of a marker with its white margin.
cv::Mat paint(const Placement& placement) {
  if (std::string_view(placement.kind) != "colour") return paint_tag(placement.kind, placement.id);
  return paint_marker(placement.id == 300   ? cv::Scalar(210, 20, 210)
                      : placement.id == 180 ? cv::Scalar(20, 200, 200)
                                            : cv::Scalar(20, 190, 20));
}

/// Adds a marker's rod: from the ceiling if it is high, so that none hides the board.
void add_rod(Scenery& room, const Vector3d& marker, double side, double yaw,
             const cv::Mat& colour) {
  constexpr double kThick = 0.012, kHigh = 1.3;  // [m]
  const bool hangs = marker.z() > kHigh;
  const double bottom = hangs ? marker.z() + side / 2 : 0;
  const double top = hangs ? kRoomCeiling : marker.z() - side / 2;
  const Vector3d behind = 0.012 * Vector3d(std::cos(yaw), std::sin(yaw), 0);
  room.add_box({kThick, kThick, top - bottom},
               Vector3d(marker.x(), marker.y(), (bottom + top) / 2) + behind, colour, yaw);
}

}  // namespace

std::vector<RoomMarker> add_markers(Scenery& room, bool only_on_wall) {
  const double d = 0.06;  // random offset of a position [m]
  auto near = [&](double x, double y, double z) {
    const double dz = room.random(-d, d), dy = room.random(-d, d), dx = room.random(-d, d);
    return Vector3d(x + dx, y + dy, z + dz);
  };
  const Placement placements[] = {
      // Straight ahead of the neck, along the world's x axis.
      {"apriltag", 0, 0.30, {kRoomFront - 0.02, 0, kHeadHeight}, 0},
      {"apriltag", 7, 0.16, near(2.9, -1.05, 1.45), -0.35 + room.random(-0.2, 0.2)},
      {"aruco", 23, 0.18, near(2.9, -0.55, 1.75), -0.2 + room.random(-0.2, 0.2)},
      {"aruco", 40, 0.14, near(2.1, 1.75, 1.2), 0.7 + room.random(-0.2, 0.2)},
      {"colour", 300, 0.14, near(2.6, 0.35, 1.75), 0.1 + room.random(-0.2, 0.2)},
      {"colour", 180, 0.12, near(2.1, -2.1, 1.25), -0.75 + room.random(-0.2, 0.2)},
      {"colour", 120, 0.12, near(2.2, 0.75, 1.0), 0.3 + room.random(-0.2, 0.2)},
  };
  std::vector<RoomMarker> markers;
  for (const auto& placement : placements) {
    const bool is_on_wall = placement.id == 0;
    if (only_on_wall && !is_on_wall) continue;
    // The margin is 1/6 of the image of a colour marker, else one of ten cells.
    const bool is_colour = std::string_view(placement.kind) == "colour";
    const auto whole = static_cast<float>(placement.side * (is_colour ? 1.5 : 1.25));
    const Isometry3d place = hang(placement.place, placement.yaw);
    room.add(make_rectangle(whole, whole), paint(placement), place);
    if (!is_on_wall) {
      const cv::Mat grey(1, 1, CV_8UC3, cv::Scalar(90, 90, 92));
      room.add(make_box({whole, whole, 0.01F}), grey, place * Translation3d(0, 0, 0.006));
      add_rod(room, placement.place, whole, placement.yaw, grey);
    }
    markers.push_back({placement.kind, placement.id, placement.side, place});
  }
  return markers;
}

}  // namespace hc::room
