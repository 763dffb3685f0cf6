// SPDX-License-Identifier: Apache-2.0
#include "parameters.h"

#include <gtest/gtest.h>

#include <room/scenery.h>

namespace {

/// The parameters with some set as on the command line.
class ParametersTest : public testing::Test {
 protected:
  void set(std::string_view name, std::string_view text) {
    for (const auto& each : hc::ModuleAccess::parameters(module))
      if (each->name == name) {
        ASSERT_TRUE(each->set(text)) << name;
        return;
      }
    FAIL() << name;
  }
  hc::Module module{"eyes", "A head."};
  const Parameters parameters{module};
};

TEST_F(ParametersTest, the_camera_looks_through_the_middle_of_its_image) {
  set("width", "320");
  set("height", "201");
  set("focal", "250");
  const auto camera = parameters.camera();
  EXPECT_EQ(camera.width, 320);
  EXPECT_EQ(camera.height, 201);
  EXPECT_EQ(camera.project({0, 0, 2}), Eigen::Vector2d(159.5, 100));
  EXPECT_EQ(camera.project({1, 1, 2}), Eigen::Vector2d(159.5 + 125, 100 + 125));
}

/// Of an eye that looks straight ahead.
const Eigen::Isometry3d optical = hc::room::hang(Eigen::Vector3d::Zero(), 0);

TEST_F(ParametersTest, faults_turn_the_eyes_as_they_are_named) {
  set("zero_pan", "0.1");     // to the left
  set("zero_tilt", "0.2");    // down
  set("offset_yaw", "0.05");  // about the eye's y, which is down: to the right
  const hc::room::Head mounted{optical, optical};
  const auto head = mounted.with(parameters.faults());
  const Eigen::Vector3d forward = head.left_eye.linear().col(2);
  EXPECT_NEAR(std::atan2(forward.y(), forward.x()), 0.1, 1e-12);
  EXPECT_NEAR(std::asin(-forward.z()), 0.2, 1e-12);
  const Eigen::Vector3d other = head.left_eye.linear().transpose() * head.right_eye.linear().col(2);
  EXPECT_NEAR(std::atan2(other.x(), other.z()), 0.05, 1e-12);
}

TEST_F(ParametersTest, the_ball_does_what_is_said) {
  set("ball", "hide");
  set("ball_speed", "0.5");
  set("ball_hidden", "3");
  set("seed", "4");
  const auto motion = parameters.motion();
  EXPECT_EQ(motion.kind, "hide");
  EXPECT_EQ(motion.speed, 0.5);
  EXPECT_EQ(motion.hidden, 3);
  EXPECT_EQ(motion.seed, 4U);
}

}  // namespace
