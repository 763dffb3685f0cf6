// SPDX-License-Identifier: Apache-2.0
#include "scene.h"

#include <gtest/gtest.h>

namespace {

using namespace std::chrono_literals;

constexpr hc::Time kBegin(1s);

Eigen::Isometry3d at(double x) {
  return Eigen::Isometry3d(Eigen::Translation3d(x, 0, 0));
}

TEST(Markers, are_known_once_they_were_seen) {
  Markers markers;
  EXPECT_EQ(markers.find(101), nullptr);
  markers.see(101, kBegin, at(1), 0.2);
  EXPECT_EQ(markers.find(102), nullptr);
  ASSERT_NE(markers.find(101), nullptr);
  EXPECT_EQ(markers.find(101)->translation().x(), 1);
}

TEST(Markers, that_tremble_are_smoothed_and_that_are_moved_are_not) {
  Markers markers;
  markers.see(101, kBegin, at(1), 0.2);
  markers.see(101, kBegin + 50ms, at(1.01), 0.2);
  EXPECT_NEAR(markers.find(101)->translation().x(), 1 + 0.01 * (1 - std::exp(-0.05 / 0.2)), 1e-9);
  markers.see(101, kBegin + 1s, at(2), 0.2);
  EXPECT_EQ(markers.find(101)->translation().x(), 2);
}

struct Scenes : testing::Test {
  void make(const std::string& objects) {
    auto renderer = hc::graphics::Renderer::make();
    ASSERT_TRUE(renderer) << renderer.error().text();
    auto made = Scene::make(objects, std::move(*renderer));
    ASSERT_TRUE(made) << made.error().text();
    scene = std::move(*made);
  }

  hc::Module module{"test", "A test."};
  hc::ModuleFrames frames{module, {.input = false}};
  std::unique_ptr<Scene> scene;
  Markers markers;
};

TEST_F(Scenes, have_objects_in_frames_and_at_markers) {
  make("cube at left_eye 0 0 2 size 0.2; ball at 101 size 0.1; ball at 4");
  scene->place(frames, markers, kBegin);
  ASSERT_EQ(scene->bodies().size(), 2U);  // those of the left eye, 4
  EXPECT_TRUE(
      scene->bodies()[0].T_world_body.translation().isApprox(Eigen::Vector3d(2.06, 0.05, 1.25)));
  markers.see(101, kBegin, at(3), 0);
  scene->place(frames, markers, kBegin);
  ASSERT_EQ(scene->bodies().size(), 3U);
  EXPECT_EQ(scene->bodies()[1].T_world_body.translation().x(), 3);
}

TEST_F(Scenes, have_objects_between_two_markers) {
  make("cube at 101 to 102 size fit; cube at 101 to 102 0 0 1 size 0.5");
  markers.see(101, kBegin, at(3), 0);
  scene->place(frames, markers, kBegin);
  EXPECT_TRUE(scene->bodies().empty()) << "one of them has not been seen";
  markers.see(102, kBegin, at(5), 0);
  scene->place(frames, markers, kBegin);
  ASSERT_EQ(scene->bodies().size(), 2U);
  EXPECT_TRUE(scene->bodies()[0].corners().back().isApprox(Eigen::Vector3d(5, 1, 1)));
  EXPECT_TRUE(scene->bodies()[1].corners().back().isApprox(Eigen::Vector3d(4.25, 0.25, 1.25)));
  markers.see(102, kBegin, at(3), 0);
  scene->place(frames, markers, kBegin);
  EXPECT_TRUE(scene->bodies().empty()) << "they are at one place";
}

TEST_F(Scenes, have_no_objects_in_frames_that_there_are_not) {
  make("ball at nowhere");
  EXPECT_THROW(scene->place(frames, markers, kBegin), hc::ModuleError);
}

TEST_F(Scenes, say_whether_an_eye_sees_anything) {
  hc::Header header;
  header.width = 80;
  header.height = 60;
  const Sight sight = Pair().at(header, {100, 100, 39.5, 29.5, 0.1}, frames);
  for (const auto& [objects, is_seen] : {std::pair{"cube at left_eye 0 0 2 size 0.2", true},
                                         {"cube at left_eye 0 0 -2 size 0.2", false},
                                         {"", false}}) {
    scene.reset();
    make(objects);
    scene->place(frames, markers, kBegin);
    EXPECT_EQ(scene->is_seen(sight), is_seen) << objects;
  }
}

}  // namespace
