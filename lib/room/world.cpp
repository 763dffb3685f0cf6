// SPDX-License-Identifier: Apache-2.0
#include <room/world.h>

#include <cmath>

#include <room/ball.h>
#include <room/paint.h>
#include <room/pointing.h>
#include <room/room.h>
#include <room/screen.h>

namespace hc::room {

namespace {

using Eigen::Vector3d;

constexpr float kBoardWidth = 1.5F, kBoardHeight = 0.36F;  // [m]

}  // namespace

World::World(graphics::Renderer& renderer, std::uint64_t seed, const std::string& text, int people)
    : room_(renderer, seed) {
  light_.to_light = Eigen::Vector3f(static_cast<float>(room_.random(-0.6, -0.2)),
                                    static_cast<float>(room_.random(-0.5, 0.5)), 0.8F)
                        .normalized();
  const auto floor = add_room(room_);
  const bool is_cleared = people > 0;
  add_furniture(room_, is_cleared);
  if (is_cleared) add_things(room_);
  if (!is_cleared) add_bench(room_);
  if (!is_cleared) add_screen(room_);
  markers_ = add_markers(room_, is_cleared);
  add_board(is_cleared ? 4.1 : 3.3);
  add_shadows(room_, floor, light_.to_light.cast<double>());
  write(text);
  room_.add(graphics::make_ball(static_cast<float>(kBallRadius)),
            paint_grains(64, 64, {205, 22, 22}, 14, seed), Eigen::Isometry3d::Identity());
  for (int i = 0; i < people; ++i) figures_.emplace_back(renderer, i);
}

void World::add_board(double x) {
  const Vector3d middle = {x + room_.random(-0.1, 0.1), 1.15 + room_.random(-0.1, 0.1),
                           1.4 + room_.random(-0.1, 0.1)};
  const double towards = std::atan2(middle.y(), middle.x());
  room_.add_box({0.03, kBoardWidth + 0.06F, kBoardHeight + 0.06F},
                middle + 0.02 * Vector3d(std::cos(towards), std::sin(towards), 0),
                cv::Mat(1, 1, CV_8UC3, cv::Scalar(70, 75, 80)), towards);
  for (const double side : {-0.48, 0.48}) {  // posts
    const Vector3d along = side * kBoardWidth * Vector3d(-std::sin(towards), std::cos(towards), 0);
    const double height = middle.z() - kBoardHeight / 2;
    room_.add_box({0.03, 0.03, height},
                  Vector3d(middle.x(), middle.y(), height / 2) + along +
                      0.02 * Vector3d(std::cos(towards), std::sin(towards), 0),
                  cv::Mat(1, 1, CV_8UC3, cv::Scalar(70, 75, 80)), towards);
  }
  room_.add(graphics::make_rectangle(kBoardWidth, kBoardHeight),
            cv::Mat(1, 1, CV_8UC3, cv::Scalar::all(255)), hang(middle, towards));
  board_ = room_.items().back().surface;
}

const std::vector<graphics::Item>& World::items(const Vector3d& ball,
                                                const std::vector<Person>& people) {
  room_.move_last(ball);
  if (figures_.empty()) return room_.items();
  items_ = room_.items();
  for (const auto& person : people)
    figures_.at(static_cast<std::size_t>(person.number)).add_to(items_, person);
  return items_;
}

void World::write(const std::string& text) {
  text_ = text;
  room_.set_texture(board_, paint_board(text, 1000, 240));
}

}  // namespace hc::room
