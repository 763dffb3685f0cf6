// SPDX-License-Identifier: Apache-2.0
#include <room/world.h>

#include <cmath>

#include <gtest/gtest.h>

#include <room/ball.h>
#include <room/head.h>
#include <room/people.h>
#include <room/screen.h>

namespace hc::room {

namespace {

class Room : public testing::Test {
 protected:
  void SetUp() override {
    auto made = graphics::Renderer::make();
    ASSERT_TRUE(made) << made.error().text();
    renderer = std::move(*made);
    world = std::make_unique<World>(*renderer, 1, "HELLO");
  }

  /// The left eye's image with pan and tilt [rad].
  cv::Mat look(double pan, double tilt, const Eigen::Vector3d& ball, cv::Mat* depth = nullptr) {
    T_world_left = head_pose(pan, tilt) * Head::nominal().left_eye;
    cv::Mat rgb;
    EXPECT_TRUE(
        renderer->draw(world->items(ball), camera, T_world_left, world->light(), rgb, depth));
    return rgb;
  }

  [[nodiscard]] Eigen::Vector2d pixel_of(const Eigen::Vector3d& p_world) const {
    return camera.project(T_world_left.inverse() * p_world);
  }

  std::unique_ptr<graphics::Renderer> renderer;
  std::unique_ptr<World> world;
  graphics::PinholeCamera camera;
  Eigen::Isometry3d T_world_left;
};

TEST_F(Room, the_eyes_look_forward_left_up_as_the_head_does) {
  look(0, 0, {9, 9, 9});
  EXPECT_LT(pixel_of({3, 1, kHeadHeight}).x(), camera.cx);      // left
  EXPECT_LT(pixel_of({3, 0, kHeadHeight + 1}).y(), camera.cy);  // above
  look(0.3, 0, {9, 9, 9});
  EXPECT_NEAR(pixel_of({3 * std::cos(0.3), 3 * std::sin(0.3), 1.25}).x(), camera.cx, 12);
  look(0, 0.2, {9, 9, 9});
  EXPECT_GT(pixel_of({3, 0, 0.2}).y(), 0);  // down
  EXPECT_LT(pixel_of({3, 0, 0.2}).y(), camera.height);
}

TEST_F(Room, the_ball_is_red_where_it_should_be_and_its_depth_true) {
  const Eigen::Vector3d ball = Ball({"still", 0, 0, 1}).at(0).position;
  cv::Mat depth;
  const cv::Mat rgb = look(0, 0.2, ball, &depth);
  const auto pixel = pixel_of(ball);
  const auto colour = rgb.at<cv::Vec3b>(int(pixel.y()), int(pixel.x()));
  EXPECT_GT(colour[0], 4 * colour[1]);
  EXPECT_GT(colour[0], 4 * colour[2]);
  const double range = (T_world_left.inverse() * ball).norm();
  EXPECT_NEAR(depth.at<float>(int(pixel.y()), int(pixel.x())), range - kBallRadius, 0.02);
}

TEST_F(Room, the_screen_hides_the_ball_as_its_truth_says) {
  for (double angle : {kScreenAngle, kScreenAngle + 0.1, kScreenAngle + 0.15, 0.3}) {
    const Eigen::Vector3d ball(kArcRadius * std::cos(angle), kArcRadius * std::sin(angle),
                               kArcHeight + kBallRadius);
    const cv::Mat rgb = look(angle, 0.2, ball);
    int red = 0;
    for (int v = 0; v < rgb.rows; ++v)
      for (int u = 0; u < rgb.cols; ++u) {
        const auto& c = rgb.at<cv::Vec3b>(v, u);
        if (c[0] > 60 && c[0] > 3 * c[1] && c[0] > 3 * c[2]) ++red;
      }
    const double radius = camera.fx * kBallRadius / (T_world_left.inverse() * ball).z();
    EXPECT_NEAR(red / (3.14159 * radius * radius), share_seen(ball, T_world_left.translation()),
                0.08)
        << angle;
  }
}

TEST_F(Room, every_marker_is_seen_from_the_neck) {
  ASSERT_EQ(world->markers().size(), 7U);
  for (const auto& marker : world->markers()) {
    const Eigen::Vector3d p = marker.T_world_marker.translation();
    const double pan = std::atan2(p.y(), p.x());
    cv::Mat depth;
    look(pan, 0, {9, 9, 9}, &depth);
    const auto pixel = pixel_of(p);
    const double z = (T_world_left.inverse() * p).z();
    EXPECT_NEAR(depth.at<float>(int(std::lround(pixel.y())), int(std::lround(pixel.x()))), z, 0.01)
        << marker.kind << " " << marker.id;
    // It faces the viewer.
    EXPECT_GT(marker.T_world_marker.linear().col(2).dot(p - T_world_left.translation()), 0);
  }
}

/// Distance of a place on the floor from a box, seen from above; 0 within it [m].
double distance(const Eigen::Vector2d& place, const std::array<Eigen::Vector3d, 8>& corners) {
  Eigen::AlignedBox2d around;
  for (const auto& corner : corners) around.extend(corner.head<2>());
  return around.exteriorDistance(place);
}

TEST_F(Room, with_people_leaves_them_space_between_the_furniture) {
  for (std::uint64_t seed = 1; seed < 4; ++seed) {
    const World cleared(*renderer, seed, "HELLO", 3);
    EXPECT_EQ(cleared.markers().size(), 1U);
    for (const auto* kind : {"still", "walk", "cross"}) {
      People people({3, kind, seed});
      for (double t = 0; t < 20; t += 0.2)
        for (const auto& person : people.at(t))
          for (const auto& box : cleared.boxes())
            EXPECT_GT(distance(person.T_world_body.translation().head<2>(), box), 0.3)
                << kind << box[0].transpose();
    }
  }
}

TEST_F(Room, shows_the_persons_where_they_are) {
  world = std::make_unique<World>(*renderer, 1, "HELLO", 3);
  const auto all = People({3, "still", 1}).at(0);
  const Eigen::Vector3d nowhere(0, 0, -10);
  cv::Mat depth;
  T_world_left = head_pose(0, 0) * Head::nominal().left_eye;
  cv::Mat rgb;
  ASSERT_TRUE(renderer->draw(world->items(nowhere, all), camera, T_world_left, world->light(), rgb,
                             &depth));
  for (const auto& person : all) {
    const Eigen::Vector3d nose = person.T_world_face * Eigen::Vector3d(0.02, 0, -0.034);
    const auto pixel = pixel_of(nose);
    const double z = (T_world_left.inverse() * nose).z();
    EXPECT_NEAR(depth.at<float>(int(std::lround(pixel.y())), int(std::lround(pixel.x()))), z, 0.02)
        << person.number;
  }
}

}  // namespace

}  // namespace hc::room
