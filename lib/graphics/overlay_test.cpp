// SPDX-License-Identifier: Apache-2.0
#include <graphics/overlay.h>

#include <gtest/gtest.h>

namespace hc::graphics {
namespace {

const cv::Vec3b kGrey(100, 100, 100);
constexpr double kScale = 60;  // [px · m]

class Augmenting : public testing::Test {
 protected:
  void SetUp() override {
    auto made = Renderer::make();
    ASSERT_TRUE(made) << made.error().text();
    renderer = std::move(*made);
    overlay = std::make_unique<Overlay>(*renderer);
  }

  Body cube_at(double x, double y, double z, const cv::Vec3b& colour = {250, 0, 0}) {
    Body body =
        make_body(*renderer, {{make_box({1, 1, 1}), cv::Mat(1, 1, CV_8UC3, cv::Scalar(colour))}});
    body.set_size(0.4);
    body.T_world_body = Eigen::Translation3d(x, y, z);
    return body;
  }

  /// @param scene  depth of the scene [m]; 0: no occlusion.
  void draw(const std::vector<Body>& bodies, const cv::Mat& scene = {}) {
    Overlay::View view{camera, Eigen::Isometry3d::Identity(), {}, kScale, {}};
    if (!scene.empty())
      view.nearness = [&](const cv::Rect& part, cv::Mat& nearness) {
        nearness = kScale / scene(part);
      };
    mask = 0;
    auto drawn = overlay->draw(bodies, view, image, &mask);
    ASSERT_TRUE(drawn) << drawn.error().text();
  }

  [[nodiscard]] bool is_drawn(int y, int x) const { return mask.at<std::uint8_t>(y, x) >= 250; }
  [[nodiscard]] bool is_untouched(int y, int x) const {
    return mask.at<std::uint8_t>(y, x) == 0 && image.at<cv::Vec3b>(y, x) == kGrey;
  }

  std::unique_ptr<Renderer> renderer;
  std::unique_ptr<Overlay> overlay;
  PinholeCamera camera{320, 240, 300, 300, 160, 120, 0.05, 50};
  cv::Mat image{240, 320, CV_8UC3, cv::Scalar(kGrey)}, mask{240, 320, CV_8U, cv::Scalar(0)};
};

TEST_F(Augmenting, a_body_is_where_the_whole_image_would_have_it) {
  const auto body = cube_at(0.3, -0.2, 2);
  cv::Mat rgb, depth;
  ASSERT_TRUE(renderer->draw(body.items(), camera, Eigen::Isometry3d::Identity(), {}, rgb, &depth));
  draw({body});
  for (int y = 0; y < 240; ++y)
    for (int x = 0; x < 320; ++x) {
      ASSERT_EQ(mask.at<std::uint8_t>(y, x) > 0, depth.at<float>(y, x) > 0) << x << ' ' << y;
      if (mask.at<std::uint8_t>(y, x) == 255) {
        ASSERT_EQ(image.at<cv::Vec3b>(y, x), rgb.at<cv::Vec3b>(y, x));
      }
      if (mask.at<std::uint8_t>(y, x) == 0) {
        ASSERT_TRUE(is_untouched(y, x)) << x << ' ' << y;
      }
    }
}

TEST_F(Augmenting, the_scene_hides_what_is_behind_it) {
  cv::Mat scene(240, 320, CV_32F, cv::Scalar(5));
  scene(cv::Rect(0, 0, 160, 240)) = 1;                            // the left half is near
  image(cv::Rect(160, 0, 160, 240)) = cv::Scalar(180, 180, 180);  // and looks otherwise
  draw({cube_at(0, 0, 2)}, scene);
  EXPECT_TRUE(is_untouched(120, 140));
  EXPECT_TRUE(is_drawn(120, 180));
}

TEST_F(Augmenting, an_edge_of_depth_that_is_off_moves_to_that_of_the_image) {
  cv::Mat scene(240, 320, CV_32F, cv::Scalar(5));
  scene(cv::Rect(0, 0, 164, 240)) = 1;  // 4 px too wide
  image(cv::Rect(160, 0, 160, 240)) = cv::Scalar(180, 180, 180);
  draw({cube_at(0, 0, 2)}, scene);
  EXPECT_TRUE(is_untouched(120, 158));
  EXPECT_GT(mask.at<std::uint8_t>(120, 162), 200);
}

TEST_F(Augmenting, what_stands_on_a_surface_is_seen_whole) {
  const cv::Mat scene(240, 320, CV_32F, cv::Scalar(1.8));  // at its front
  draw({cube_at(0, 0, 2)}, scene);
  EXPECT_TRUE(is_drawn(120, 160));
  EXPECT_TRUE(is_drawn(100, 140));
}

TEST_F(Augmenting, of_two_bodies_the_nearer_hides) {
  const auto near = cube_at(0.1, 0, 1.5, {0, 250, 0}), far = cube_at(0, 0, 3);
  for (const auto& both : {std::vector{near, far}, std::vector{far, near}}) {
    image = cv::Scalar(kGrey);
    draw(both);
    EXPECT_EQ(image.at<cv::Vec3b>(120, 170)[0], 0);
    EXPECT_GT(image.at<cv::Vec3b>(120, 170)[1], 0);
  }
}

TEST_F(Augmenting, nothing_is_drawn_of_what_is_not_seen) {
  draw({cube_at(0, 0, -2), cube_at(9, 0, 2), cube_at(0, -1e9, 2)});
  EXPECT_EQ(cv::countNonZero(mask), 0);
  EXPECT_TRUE(part_of(cube_at(0, 0, -2), camera, Eigen::Isometry3d::Identity()).empty());
}

TEST_F(Augmenting, a_body_around_the_camera_is_no_error) {
  draw({cube_at(0, 0, 0.1)});
  EXPECT_EQ(part_of(cube_at(0, 0, 0.1), camera, Eigen::Isometry3d::Identity()),
            cv::Rect(0, 0, 320, 240));
}

TEST_F(Augmenting, a_size_is_that_of_the_longest_side) {
  Body body =
      make_body(*renderer, {{make_box({1, 4, 2}), cv::Mat(1, 1, CV_8UC3, cv::Scalar(9, 9, 9))}});
  EXPECT_TRUE(body.corners().back().isApprox(Eigen::Vector3d(0.5, 2, 1)));
  body.set_size(2);
  EXPECT_TRUE(body.corners().back().isApprox(Eigen::Vector3d(0.25, 1, 0.5)));
}

TEST_F(Augmenting, a_body_is_as_bright_whatever_its_size) {
  cv::Vec3b before;
  for (const double size : {0.2, 0.4, 0.8}) {
    Body body = cube_at(0, 0, 2);
    body.set_size(size);
    draw({body});
    const auto now = image.at<cv::Vec3b>(120, 160);
    if (size > 0.2) {
      EXPECT_EQ(now, before) << size;
    }
    before = now;
  }
}

}  // namespace
}  // namespace hc::graphics
