// SPDX-License-Identifier: Apache-2.0
// In simulated rooms without people there are no faces.
#include <people/box.h>
#include <people/face_search.h>
#include <room/ball.h>
#include <room/head.h>
#include <room/world.h>

#include <gtest/gtest.h>

#include <array>

namespace {

using hc::people::FaceFinder, hc::people::FaceSearch;

/// A view in which the large network sees a face.
struct View {
  std::uint64_t room;
  double time;       // of the ball [s]
  double pan, tilt;  // [rad]
};

constexpr std::array kViews = {
    View{3, 0.37 * 29, -0.381, 0.286},   View{3, 0.37 * 76, -0.384, 0.378},
    View{4, 0.37 * 95, 0.449, 0.283},    View{4, 0.37 * 120, 0.248, 0.337},
    View{12, 0.37 * 109, -0.090, 0.352}, View{12, 0.37 * 145, 0.350, 0.365},
    View{12, 0.37 * 194, 0.003, 0.405}};

/// The left eye's image.
cv::Mat image_of(const View& view, hc::graphics::Renderer& renderer) {
  hc::room::World world(renderer, view.room, "", 0);
  hc::room::Ball ball({.seed = view.room});
  const Eigen::Isometry3d T_world_eye =
      hc::room::head_pose(view.pan, view.tilt) * hc::room::Head::nominal().left_eye;
  cv::Mat image;
  EXPECT_TRUE(renderer.draw(world.items(ball.at(view.time).position), {}, T_world_eye,
                            world.light(), image));
  return image;
}

TEST(Rooms, without_people_are_without_faces) {
  auto renderer = hc::graphics::Renderer::make();
  ASSERT_TRUE(renderer) << renderer.error().text();
  auto wide = FaceFinder::read_wide();
  auto search = FaceSearch::read();
  ASSERT_TRUE(wide && search);
  std::size_t seen = 0;
  hc::Time time{};
  for (const View& view : kViews) {
    const cv::Mat image = image_of(view, **renderer);
    for (const cv::Rect& part : hc::people::parts_of(image.size(), wide->size()))
      seen += wide->find(image, part, FaceSearch::kPossible).size();
    time += std::chrono::hours(1);  // so that all parts are searched
    EXPECT_TRUE(search->look(time, image).empty())
        << "room " << view.room << " at " << view.time << " s";
  }
  EXPECT_GT(seen, 0U) << "the large network alone sees faces there";
}

}  // namespace
