// SPDX-License-Identifier: Apache-2.0
#include <room/room.h>

#include <cmath>
#include <numbers>
#include <vector>

#include <opencv2/imgproc.hpp>

#include <room/ball.h>
#include <room/paint.h>
#include <room/pointing.h>

namespace hc::room {

namespace {

using Eigen::Isometry3d;
using Eigen::Translation3d;
using Eigen::Vector3d;
using graphics::make_ball;
using graphics::make_rectangle;

constexpr double kPi = std::numbers::pi;

/// Image x is the world's x; the robot's left is at the top.
cv::Mat paint_floor(std::uint64_t seed) {
  const cv::Mat planks = paint_planks(512, 512, seed);
  cv::Mat floor;
  cv::resize(cv::repeat(planks, 3, 3), floor, {1024, 1024}, 0, 0, cv::INTER_AREA);
  return floor;
}

}  // namespace

graphics::SurfaceId add_room(Scenery& room) {
  const double length = kRoomFront - kRoomBack, middle = (kRoomFront + kRoomBack) / 2;
  auto wall = [&](const Vector3d& place, double yaw, double width) {
    const double grey = room.random(165, 200);
    const auto seed = static_cast<std::uint64_t>(room.random(0, 1e6));
    const double green = grey + room.random(-6, 6), blue = grey + room.random(-8, 8);
    room.add(make_rectangle(static_cast<float>(width), static_cast<float>(kRoomCeiling)),
             paint_grains(1024, 512, {grey, green, blue}, 26, seed), hang(place, yaw));
  };
  wall({kRoomFront, 0, kRoomCeiling / 2}, 0, 2 * kRoomSide);
  wall({middle, kRoomSide, kRoomCeiling / 2}, kPi / 2, length);
  wall({middle, -kRoomSide, kRoomCeiling / 2}, -kPi / 2, length);
  wall({kRoomBack, 0, kRoomCeiling / 2}, kPi, 2 * kRoomSide);
  // Seen from above, the floor has x to the right.
  Eigen::Matrix3d down, up;
  down << 1, 0, 0, 0, -1, 0, 0, 0, -1;
  up << 1, 0, 0, 0, 1, 0, 0, 0, 1;
  room.add(make_rectangle(static_cast<float>(length), 2 * static_cast<float>(kRoomSide)),
           paint_floor(room.seed()), Translation3d(middle, 0, 0) * Isometry3d(down));
  const auto floor = room.items().back().surface;
  room.add(make_rectangle(static_cast<float>(length), 2 * static_cast<float>(kRoomSide), {2, 2}),
           paint_grains(256, 256, {225, 225, 222}, 10, room.seed()),
           Translation3d(middle, 0, kRoomCeiling) * Isometry3d(up));
  for (int i = 0; i < 5; ++i) {
    const auto poster = paint_poster(256, 192, room.seed() * 16 + static_cast<std::uint64_t>(i));
    const double height = room.random(1.2, 2.0), along = room.random(-0.4, 0.4);
    Isometry3d place = hang({kRoomFront - 0.01, 2.4 - 2.4 * i + along, height}, 0);
    if (i == 3) place = hang({1.5 + along, kRoomSide - 0.01, height}, kPi / 2);
    if (i == 4) place = hang({1.5 + along, -kRoomSide + 0.01, height}, -kPi / 2);
    room.add(make_rectangle(1.0F, 0.75F), poster, place);
  }
  return floor;
}

void add_shadows(Scenery& room, graphics::SurfaceId floor, const Vector3d& to_light) {
  cv::Mat image = paint_floor(room.seed()), light(image.size(), CV_8U, cv::Scalar(255));
  constexpr double kShade = 150, kSoft = 5;  // of 255; [px]
  for (const auto& corners : room.boxes()) {
    std::vector<cv::Point> outline, hull;
    for (const auto& corner : corners) {
      const Vector3d on_floor = corner - corner.z() / to_light.z() * to_light;
      outline.emplace_back(
          static_cast<int>((on_floor.x() - kRoomBack) / (kRoomFront - kRoomBack) * image.cols),
          static_cast<int>((kRoomSide - on_floor.y()) / (2 * kRoomSide) * image.rows));
    }
    cv::convexHull(outline, hull);
    cv::fillConvexPoly(light, hull, kShade);
  }
  cv::GaussianBlur(light, light, {}, kSoft);
  cv::cvtColor(light, light, cv::COLOR_GRAY2BGR);
  cv::multiply(image, light, image, 1.0 / 255);
  room.set_texture(floor, image);
}

void add_furniture(Scenery& room, bool is_cleared) {
  const auto wood = paint_planks(256, 256, room.seed() + 5);
  auto cloth = [&](double r, double g, double b) {
    return paint_grains(128, 128, {r, g, b}, 34, static_cast<std::uint64_t>(room.random(0, 1e6)));
  };
  // A table behind the ball's bench, on the left, with a box and a pot on it. One random number per
  // statement, since the order of evaluation in an expression is unspecified.
  auto about = [&](double value, double most) { return value + room.random(-most, most); };
  const double table_y = about(1.2, 0.1), table_x = about(is_cleared ? 4.05 : 3.3, 0.1);
  const Vector3d table(table_x, table_y, 0);
  room.add_box({0.8, 1.4, 0.04}, table + Vector3d(0, 0, 0.74), wood);
  for (double x : {-0.35, 0.35})
    for (double y : {-0.63, 0.63})
      room.add_box({0.05, 0.05, 0.72}, table + Vector3d(x, y, 0.36), wood);
  const double box_yaw = about(0, 1);
  room.add_box({0.22, 0.3, 0.2}, table + Vector3d(-0.1, 0.35, 0.86), cloth(92, 104, 128), box_yaw);
  room.add(make_ball(0.14F), cloth(150, 146, 120),
           Isometry3d(Translation3d(table + Vector3d(-0.15, -0.3, 0.9))));
  // A shelf at the right of the front wall.
  const Vector3d shelf(kRoomFront - 0.2, -2.2 + room.random(-0.2, 0.2), 0);
  for (int board = 0; board < 5; ++board)
    room.add_box({0.36, 1.2, 0.03}, shelf + Vector3d(0, 0, 0.05 + 0.42 * board), wood);
  for (double y : {-0.6, 0.6}) room.add_box({0.36, 0.03, 1.76}, shelf + Vector3d(0, y, 0.88), wood);
  for (int board = 0; board < 4; ++board)
    for (double y = -0.55; y < 0.45;) {
      const double thick = room.random(0.03, 0.09), high = room.random(0.2, 0.34);
      const double tint = room.random(-22, 22), grey = room.random(60, 190);
      room.add_box({0.22, thick, high},
                   shelf + Vector3d(-0.03, y + thick / 2, 0.065 + 0.42 * board + high / 2),
                   cloth(grey + tint, grey, grey - tint));
      y += thick + 0.004;
    }
  // A stool in front of the bench, a chest and a cushion behind it.
  const double stool_yaw = about(0, 1);
  const auto stool_cloth = cloth(118, 110, 96);
  const double stool_x = about(1.55, 0.1), stool_y = about(0.75, 0.1);
  if (!is_cleared) room.add_box({0.3, 0.3, 0.4}, {stool_x, stool_y, 0.2}, stool_cloth, stool_yaw);
  const auto chest_cloth = cloth(96, 100, 110);
  room.add_box({0.5, 0.9, 0.6}, {3.9, about(-0.4, 0.2), 0.3}, chest_cloth);
  const double cushion_y = about(-2.6, 0.2);
  room.add(make_ball(0.2F), cloth(170, 168, 160), Isometry3d(Translation3d(3.0, cushion_y, 0.2)));
}

void add_things(Scenery& room) {
  const cv::Mat grey(1, 1, CV_8UC3, cv::Scalar(96, 96, 98));
  std::uint64_t number = 0;
  for (const auto& middle : things()) {
    const double hue = 0.9 * static_cast<double>(number);
    const cv::Scalar rgb(110 + 70 * std::cos(hue), 110 + 70 * std::cos(hue - 2.1),
                         110 + 70 * std::cos(hue - 4.2));
    room.add(make_ball(static_cast<float>(kThingRadius)), paint_grains(64, 64, rgb, 30, ++number),
             Isometry3d(Translation3d(middle)));
    const double height = middle.z() - kThingRadius;
    room.add_box({0.04, 0.04, height}, {middle.x(), middle.y(), height / 2}, grey);
  }
}

void add_bench(Scenery& room) {
  const auto wood = paint_planks(256, 64, room.seed() + 9);
  constexpr int kPieces = 16;
  const double reach = kArcEnd + 0.12, step = 2 * reach / kPieces;
  for (int i = 0; i < kPieces; ++i) {
    const double angle = -reach + (i + 0.5) * step;
    room.add_box({0.26, 1.06 * step * kArcRadius, 0.03},
                 {kArcRadius * std::cos(angle), kArcRadius * std::sin(angle), kArcHeight - 0.015},
                 wood, angle);
    if (i % 3 == 1)
      room.add_box(
          {0.05, 0.05, kArcHeight - 0.03},
          {kArcRadius * std::cos(angle), kArcRadius * std::sin(angle), (kArcHeight - 0.03) / 2},
          wood, angle);
  }
}

}  // namespace hc::room
