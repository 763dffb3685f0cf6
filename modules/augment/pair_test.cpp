// SPDX-License-Identifier: Apache-2.0
#include "pair.h"

#include <gtest/gtest.h>

namespace {

hc::Header image() {
  hc::Header header;
  header.width = 80;
  header.height = 60;
  header.time = hc::unix_time(5);
  return header;
}

hc::TimedPose pose(std::int32_t to, std::int32_t from, const Eigen::Isometry3d& T) {
  return {to, from, hc::unix_time(5), T};
}

/// With the default head: its left eye is at (0.06, 0.05, 1.25) m of the world and looks along x.
class Pairs : public testing::Test {
 protected:
  hc::Module module{"test", "A test."};
  hc::ModuleFrames frames{module, {.input = false}};
  Pair pair;
};

TEST_F(Pairs, that_are_not_described_are_the_frames) {
  const Sight sight = pair.at(image(), {100, 100, 39.5, 29.5, 0.1}, frames);
  EXPECT_EQ(sight.camera.fx, 100);
  EXPECT_EQ(sight.camera.cx, 39.5);
  EXPECT_NEAR(sight.scale, 100 * 0.1, 1e-9);
  EXPECT_TRUE(sight.in_eye(0, {2.06, 0.05, 1.25}).isApprox(Eigen::Vector3d(0, 0, 2)));
  EXPECT_TRUE(sight.in_eye(1, {2.06, 0.05, 1.25}).isApprox(Eigen::Vector3d(-0.1, 0, 2)));
}

TEST_F(Pairs, that_are_described_are_so) {
  const Eigen::Isometry3d turned(Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitY()));
  Eigen::Isometry3d mounted = frames.fixed("head", "left_eye");
  mounted.translation().z() += 0.3;
  pair.set_camera(pose(3, 4, mounted));
  pair.set_camera(pose(4, 9, turned));
  pair.set_camera(pose(1, 2, turned));  // unrelated frames
  const Sight sight = pair.at(image(), {90, 91, 40, 30, 0.2}, frames);
  EXPECT_EQ(sight.camera.fy, 91);
  EXPECT_NEAR(sight.scale, 90 * 0.2, 1e-9);
  EXPECT_NEAR(sight.T_world_eye[0].translation().z(), 1.55, 1e-9);
  const Eigen::Isometry3d expected = mounted * turned * Eigen::Translation3d(0.2, 0, 0);
  EXPECT_TRUE(sight.T_world_eye[1].linear().isApprox(expected.linear()));
  EXPECT_NEAR((sight.T_world_eye[1].translation() - sight.T_world_eye[0].translation()).norm(), 0.2,
              1e-9);
}

}  // namespace
