// SPDX-License-Identifier: Apache-2.0
#include "plates.h"

#include <string_view>

#include "paint.h"
#include "room.h"

namespace {

using Eigen::Isometry3d;
using Eigen::Translation3d;
using Eigen::Vector3d;
using hc::graphics::make_box;
using hc::graphics::make_rectangle;

struct Wish {
  const char* kind;
  int id;
  double side;
  Vector3d place;
  double yaw;
};

/// The image of a plate with its white margin.
cv::Mat paint(const Wish& wish) {
  if (std::string_view(wish.kind) != "colour") return paint_plate(wish.kind, wish.id);
  return paint_marker(wish.id == 300   ? cv::Scalar(210, 20, 210)
                      : wish.id == 180 ? cv::Scalar(20, 200, 200)
                                       : cv::Scalar(20, 190, 20));
}

/// What holds a plate: from the ceiling where it is high, so that none is before the board.
void add_rod(Scenery& room, const Vector3d& plate, double side, double yaw, const cv::Mat& colour) {
  constexpr double kThick = 0.012, kHigh = 1.3;  // [m]
  const bool hangs = plate.z() > kHigh;
  const double bottom = hangs ? plate.z() + side / 2 : 0;
  const double top = hangs ? kRoomCeiling : plate.z() - side / 2;
  const Vector3d behind = 0.012 * Vector3d(std::cos(yaw), std::sin(yaw), 0);
  room.add_box({kThick, kThick, top - bottom},
               Vector3d(plate.x(), plate.y(), (bottom + top) / 2) + behind, colour, yaw);
}

}  // namespace

std::vector<Plate> add_plates(Scenery& room) {
  const double d = 0.06;  // how far a place differs [m]
  auto near = [&](double x, double y, double z) {
    const double dz = room.random(-d, d), dy = room.random(-d, d), dx = room.random(-d, d);
    return Vector3d(x + dx, y + dy, z + dz);
  };
  const Wish wishes[] = {
      // Straight before the neck: who looks at its middle looks along the world's x.
      {"apriltag", 0, 0.30, {kRoomFront - 0.02, 0, kHeadHeight}, 0},
      {"apriltag", 7, 0.16, near(2.9, -1.05, 1.45), -0.35 + room.random(-0.2, 0.2)},
      {"aruco", 23, 0.18, near(2.9, -0.55, 1.75), -0.2 + room.random(-0.2, 0.2)},
      {"aruco", 40, 0.14, near(2.1, 1.75, 1.2), 0.7 + room.random(-0.2, 0.2)},
      {"colour", 300, 0.14, near(2.6, 0.35, 1.75), 0.1 + room.random(-0.2, 0.2)},
      {"colour", 180, 0.12, near(2.1, -2.1, 1.25), -0.75 + room.random(-0.2, 0.2)},
      {"colour", 120, 0.12, near(2.2, 0.75, 1.0), 0.3 + room.random(-0.2, 0.2)},
  };
  std::vector<Plate> plates;
  for (const auto& wish : wishes) {
    // The margin is a sixth of the image, or one cell of ten.
    const bool is_colour = std::string_view(wish.kind) == "colour";
    const auto whole = static_cast<float>(wish.side * (is_colour ? 1.5 : 1.25));
    const Isometry3d place = hang(wish.place, wish.yaw);
    room.add(make_rectangle(whole, whole), paint(wish), place);
    const bool is_on_wall = wish.id == 0;
    if (!is_on_wall) {
      const cv::Mat grey(1, 1, CV_8UC3, cv::Scalar(90, 90, 92));
      room.add(make_box({whole, whole, 0.01F}), grey, place * Translation3d(0, 0, 0.006));
      add_rod(room, wish.place, whole, wish.yaw, grey);
    }
    plates.push_back({wish.kind, wish.id, wish.side, place});
  }
  return plates;
}
