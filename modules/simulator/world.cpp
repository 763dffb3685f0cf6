// SPDX-License-Identifier: Apache-2.0
#include "world.h"

#include <cmath>
#include <numbers>

#include "ball.h"
#include "paint.h"

namespace {

using Eigen::AngleAxisd;
using Eigen::Isometry3d;
using Eigen::Translation3d;
using Eigen::Vector3d;
using hc::graphics::make_ball;
using hc::graphics::make_box;
using hc::graphics::make_rectangle;

constexpr double kPi = std::numbers::pi;
// The room [m].
constexpr double kFront = 4.6, kBack = -3.0, kSide = 3.6, kCeiling = 2.8;
constexpr float kBoardWidth = 1.5F, kBoardHeight = 0.36F;
constexpr double kScreenWidth = 0.62, kScreenHeight = 0.8, kScreenRadius = 1.95;

/// Where a picture hangs: its middle, and the yaw of the direction into it, 0 being forward.
Isometry3d hang(const Vector3d& middle, double yaw) {
  Eigen::Matrix3d optical;  // columns: x right, y down, z into, of who looks forward
  optical << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return Translation3d(middle) * AngleAxisd(yaw, Vector3d::UnitZ()) * Isometry3d(optical);
}

}  // namespace

World::World(hc::graphics::Renderer& renderer, std::uint64_t seed, const std::string& text)
    : renderer_(renderer), seed_(seed), state_(seed * 7919 + 1) {
  light_.to_light = Eigen::Vector3f(static_cast<float>(random(-0.6, -0.2)),
                                    static_cast<float>(random(-0.5, 0.5)), 0.8F)
                        .normalized();
  add_room();
  add_furniture();
  add_arc();
  add_plates();
  board_place_ = {3.3 + random(-0.1, 0.1), 1.15 + random(-0.1, 0.1), 1.4 + random(-0.1, 0.1)};
  const double towards = std::atan2(board_place_.y(), board_place_.x());
  add_box({0.03, kBoardWidth + 0.06F, kBoardHeight + 0.06F},
          board_place_ + 0.02 * Vector3d(std::cos(towards), std::sin(towards), 0),
          cv::Mat(1, 1, CV_8UC3, cv::Scalar(70, 75, 80)), towards);
  add(make_rectangle(kBoardWidth, kBoardHeight), cv::Mat(1, 1, CV_8UC3, cv::Scalar::all(255)),
      hang(board_place_, towards));
  board_ = items_.back().surface;
  write(text);
  add(make_ball(static_cast<float>(kBallRadius)), paint_grains(64, 64, {205, 22, 22}, 14, seed),
      Isometry3d::Identity());
}

double World::random(double least, double most) {
  cv::RNG random(state_);
  const double value = random.uniform(least, most);
  state_ = random.state;
  return value;
}

void World::add(const hc::graphics::Mesh& mesh, const cv::Mat& texture, const Isometry3d& place) {
  items_.push_back({renderer_.add(mesh, texture), place.cast<float>()});
}

void World::add_box(const Vector3d& size, const Vector3d& middle, const cv::Mat& texture,
                    double yaw) {
  add(make_box(size.cast<float>()), texture,
      Isometry3d(Translation3d(middle) * AngleAxisd(yaw, Vector3d::UnitZ())));
}

void World::add_room() {
  const double length = kFront - kBack, middle = (kFront + kBack) / 2;
  auto wall = [&](const Vector3d& place, double yaw, double width) {
    const double grey = random(165, 200);
    add(make_rectangle(static_cast<float>(width), static_cast<float>(kCeiling), {2, 1}),
        paint_grains(512, 512, {grey, grey + random(-6, 6), grey + random(-8, 8)}, 26,
                     static_cast<std::uint64_t>(random(0, 1e6))),
        hang(place, yaw));
  };
  wall({kFront, 0, kCeiling / 2}, 0, 2 * kSide);
  wall({middle, kSide, kCeiling / 2}, kPi / 2, length);
  wall({middle, -kSide, kCeiling / 2}, -kPi / 2, length);
  wall({kBack, 0, kCeiling / 2}, kPi, 2 * kSide);
  // Who looks down sees the floor with x to the right.
  Eigen::Matrix3d down, up;
  down << 1, 0, 0, 0, -1, 0, 0, 0, -1;
  up << 1, 0, 0, 0, 1, 0, 0, 0, 1;
  add(make_rectangle(static_cast<float>(length), 2 * static_cast<float>(kSide), {3, 3}),
      paint_planks(512, 512, seed_), Translation3d(middle, 0, 0) * Isometry3d(down));
  add(make_rectangle(static_cast<float>(length), 2 * static_cast<float>(kSide), {2, 2}),
      paint_grains(256, 256, {225, 225, 222}, 10, seed_),
      Translation3d(middle, 0, kCeiling) * Isometry3d(up));
  for (int i = 0; i < 5; ++i) {
    const auto poster = paint_poster(256, 192, seed_ * 16 + static_cast<std::uint64_t>(i));
    const double height = random(1.2, 2.0), along = random(-0.4, 0.4);
    Isometry3d place = hang({kFront - 0.01, 2.4 - 2.4 * i + along, height}, 0);
    if (i == 3) place = hang({1.5 + along, kSide - 0.01, height}, kPi / 2);
    if (i == 4) place = hang({1.5 + along, -kSide + 0.01, height}, -kPi / 2);
    add(make_rectangle(1.0F, 0.75F), poster, place);
  }
}

void World::add_furniture() {
  const auto wood = paint_planks(256, 256, seed_ + 5);
  auto cloth = [&](double r, double g, double b) {
    return paint_grains(128, 128, {r, g, b}, 34, static_cast<std::uint64_t>(random(0, 1e6)));
  };
  // A table behind the ball's bench, on the left, with a box and a pot on it.
  const Vector3d table(3.3 + random(-0.1, 0.1), 1.2 + random(-0.1, 0.1), 0);
  add_box({0.8, 1.4, 0.04}, table + Vector3d(0, 0, 0.74), wood);
  for (double x : {-0.35, 0.35})
    for (double y : {-0.63, 0.63}) add_box({0.05, 0.05, 0.72}, table + Vector3d(x, y, 0.36), wood);
  add_box({0.22, 0.3, 0.2}, table + Vector3d(-0.1, 0.35, 0.86), cloth(92, 104, 128), random(-1, 1));
  add(make_ball(0.14F), cloth(150, 146, 120),
      Isometry3d(Translation3d(table + Vector3d(-0.15, -0.3, 0.9))));
  // A shelf at the right of the front wall.
  const Vector3d shelf(kFront - 0.2, -2.2 + random(-0.2, 0.2), 0);
  for (int board = 0; board < 5; ++board)
    add_box({0.36, 1.2, 0.03}, shelf + Vector3d(0, 0, 0.05 + 0.42 * board), wood);
  for (double y : {-0.6, 0.6}) add_box({0.36, 0.03, 1.76}, shelf + Vector3d(0, y, 0.88), wood);
  for (int board = 0; board < 4; ++board)
    for (double y = -0.55; y < 0.45;) {
      const double thick = random(0.03, 0.09), high = random(0.2, 0.34), tint = random(-22, 22);
      const double grey = random(60, 190);
      add_box({0.22, thick, high},
              shelf + Vector3d(-0.03, y + thick / 2, 0.065 + 0.42 * board + high / 2),
              cloth(grey + tint, grey, grey - tint));
      y += thick + 0.004;
    }
  // Stools before and behind the bench, and a chest.
  add_box({0.3, 0.3, 0.4}, {1.55 + random(-0.1, 0.1), 0.75 + random(-0.1, 0.1), 0.2},
          cloth(118, 110, 96), random(-1, 1));
  add_box({0.5, 0.9, 0.6}, {3.9, -0.4 + random(-0.2, 0.2), 0.3}, cloth(96, 100, 110));
  add(make_ball(0.2F), cloth(170, 168, 160),
      Isometry3d(Translation3d(3.0, -2.6 + random(-0.2, 0.2), 0.2)));
}

void World::add_arc() {
  // The bench that the ball rolls on: pieces of an arc.
  const auto wood = paint_planks(256, 64, seed_ + 9);
  constexpr int kPieces = 16;
  const double reach = kArcEnd + 0.12, step = 2 * reach / kPieces;
  for (int i = 0; i < kPieces; ++i) {
    const double angle = -reach + (i + 0.5) * step;
    add_box({0.26, 1.06 * step * kArcRadius, 0.03},
            {kArcRadius * std::cos(angle), kArcRadius * std::sin(angle), kArcHeight - 0.015}, wood,
            angle);
    if (i % 3 == 1)
      add_box({0.05, 0.05, kArcHeight - 0.03},
              {kArcRadius * std::cos(angle), kArcRadius * std::sin(angle), (kArcHeight - 0.03) / 2},
              wood, angle);
  }
  // The screen that it hides behind, and its foot.
  const Vector3d towards(std::cos(kScreenAngle), std::sin(kScreenAngle), 0);
  const Vector3d middle = kScreenRadius * towards + Vector3d(0, 0, 0.72);
  T_world_screen_ = hang(middle, kScreenAngle);
  add_box({0.02, kScreenWidth, kScreenHeight}, middle + 0.012 * towards,
          paint_grains(256, 256, {120, 128, 140}, 40, seed_ + 11), kScreenAngle);
  add_box({0.3, kScreenWidth, 0.32}, kScreenRadius * towards + Vector3d(0, 0, 0.16),
          paint_grains(128, 128, {100, 100, 104}, 20, seed_ + 12), kScreenAngle);
}

void World::add_plates() {
  struct Wish {
    const char* kind;
    int id;
    double side;
    Vector3d place;
    double yaw;
  };
  const double d = 0.06;  // how far a place differs [m]
  auto near = [&](double x, double y, double z) {
    return Vector3d(x + random(-d, d), y + random(-d, d), z + random(-d, d));
  };
  const Wish wishes[] = {
      // Straight before the neck: who looks at its middle looks along the world's x.
      {"apriltag", 0, 0.30, {kFront - 0.02, 0, kNeckHeight}, 0},
      {"apriltag", 7, 0.16, near(2.9, -1.05, 1.45), -0.35 + random(-0.2, 0.2)},
      {"aruco", 23, 0.18, near(2.9, -0.55, 1.75), -0.2 + random(-0.2, 0.2)},
      {"aruco", 40, 0.14, near(2.1, 1.75, 1.2), 0.7 + random(-0.2, 0.2)},
      {"colour", 300, 0.14, near(2.6, 0.35, 1.75), 0.1 + random(-0.2, 0.2)},
      {"colour", 180, 0.12, near(2.1, -2.1, 1.25), -0.75 + random(-0.2, 0.2)},
      {"colour", 120, 0.12, near(2.2, 0.75, 1.0), 0.3 + random(-0.2, 0.2)},
  };
  for (const auto& wish : wishes) {
    const bool is_colour = std::string_view(wish.kind) == "colour";
    // The margin is a sixth of the picture, or one cell of ten.
    const auto whole = static_cast<float>(wish.side * (is_colour ? 1.5 : 1.25));
    const cv::Scalar colour = wish.id == 300   ? cv::Scalar(210, 20, 210)
                              : wish.id == 180 ? cv::Scalar(20, 200, 200)
                                               : cv::Scalar(20, 190, 20);
    const cv::Mat picture = is_colour ? paint_marker(colour) : paint_plate(wish.kind, wish.id);
    const Isometry3d place = hang(wish.place, wish.yaw);
    add(make_rectangle(whole, whole), picture, place);
    if (wish.id != 0)  // a back, seen from behind
      add(make_box({whole, whole, 0.01F}), cv::Mat(1, 1, CV_8UC3, cv::Scalar(90, 90, 92)),
          place * Translation3d(0, 0, 0.006));
    plates_.push_back({wish.kind, wish.id, wish.side, place});
  }
}

const std::vector<hc::graphics::Item>& World::items(const Vector3d& ball) {
  items_.back().T_world_object = Isometry3d(Translation3d(ball)).cast<float>();
  return items_;
}

void World::write(const std::string& text) {
  renderer_.set_texture(board_, paint_board(text, 1000, 240));
}

double World::share_seen(const Vector3d& ball, const Vector3d& from) const {
  // Rays to points of the disc that is seen.
  constexpr int kRings = 5, kRays = 16;
  const Vector3d along = (ball - from).normalized();
  const Vector3d right = along.unitOrthogonal(), down = along.cross(right);
  const Isometry3d T_screen_world = T_world_screen_.inverse();
  const Vector3d start = T_screen_world * from;
  int seen = 0;
  for (int ring = 0; ring < kRings; ++ring)
    for (int ray = 0; ray < kRays; ++ray) {
      // Rings of equal area.
      const double radius = kBallRadius * std::sqrt((ring + 0.5) / kRings);
      const double angle = 2 * kPi * ray / kRays;
      const Vector3d end =
          T_screen_world * (ball + radius * (std::cos(angle) * right + std::sin(angle) * down));
      const double share = start.z() / (start.z() - end.z());
      const Vector3d hit = start + share * (end - start);
      const bool is_hidden = share > 0 && share < 1 && std::abs(hit.x()) < kScreenWidth / 2 &&
                             std::abs(hit.y()) < kScreenHeight / 2;
      if (!is_hidden) ++seen;
    }
  return static_cast<double>(seen) / (kRings * kRays);
}
