// SPDX-License-Identifier: Apache-2.0
#include <graphics/renderer.h>

#include <gtest/gtest.h>

namespace hc::graphics {
namespace {

const Light kFlat{Eigen::Vector3f::UnitZ(), 1.0F, 0.0F, 1.0F};

cv::Mat plain(const cv::Vec3b& colour) {
  return cv::Mat(1, 1, CV_8UC3, cv::Scalar(colour));
}

Item at(SurfaceId surface, float x, float y, float z) {
  return {surface, Eigen::Isometry3f(Eigen::Translation3f(x, y, z))};
}

class Drawing : public testing::Test {
 protected:
  void SetUp() override {
    auto made = Renderer::make();
    ASSERT_TRUE(made) << made.error().text();
    renderer = std::move(*made);
  }

  cv::Mat draw(std::vector<Item> items, cv::Mat* depth = nullptr) {
    cv::Mat rgb;
    auto drawn = renderer->draw(items, camera, T_world_camera, kFlat, rgb, depth);
    EXPECT_TRUE(drawn) << drawn.error().text();
    return rgb;
  }

  std::unique_ptr<Renderer> renderer;
  PinholeCamera camera{320, 240, 250, 260, 150.25, 110.75, 0.1, 20};
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
};

/// Middle and area of the pixels that are not black.
cv::Vec3d lit(const cv::Mat& rgb) {
  cv::Vec3d sum(0, 0, 0);
  for (int v = 0; v < rgb.rows; ++v)
    for (int u = 0; u < rgb.cols; ++u)
      if (rgb.at<cv::Vec3b>(v, u) != cv::Vec3b(0, 0, 0)) sum += cv::Vec3d(u, v, 1);
  return {sum[0] / sum[2], sum[1] / sum[2], sum[2]};
}

TEST_F(Drawing, a_thing_is_seen_where_the_camera_projects_it) {
  const auto panel = renderer->add(make_rectangle(0.4F, 0.3F), plain({255, 255, 255}));
  for (const Eigen::Vector3d& p :
       {Eigen::Vector3d(0, 0, 2), Eigen::Vector3d(0.5, -0.3, 2.5), Eigen::Vector3d(-0.6, 0.4, 3)}) {
    const auto found = lit(draw({at(panel, float(p.x()), float(p.y()), float(p.z()))}));
    const auto expected = camera.project(p);
    EXPECT_NEAR(found[0], expected.x(), 0.5) << p;  // pixels are whole
    EXPECT_NEAR(found[1], expected.y(), 0.5) << p;
    const double area = 0.4 * 250 / p.z() * (0.3 * 260 / p.z());
    EXPECT_NEAR(found[2], area, 0.05 * area) << p;
  }
}

TEST_F(Drawing, its_depth_is_metric) {
  const auto wall = renderer->add(make_rectangle(50, 50), plain({255, 255, 255}));
  const auto panel = renderer->add(make_rectangle(0.2F, 0.2F), plain({255, 0, 0}));
  cv::Mat depth;
  draw({at(wall, 0, 0, 8), at(panel, 0, 0, 1.5F)}, &depth);
  EXPECT_NEAR(depth.at<float>(111, 150), 1.5, 1e-4);
  EXPECT_NEAR(depth.at<float>(10, 10), 8, 1e-3);
  draw({at(panel, 0, 0, 1.5F)}, &depth);
  EXPECT_EQ(depth.at<float>(10, 10), 0);  // nothing there
}

TEST_F(Drawing, an_image_hangs_upright_and_is_not_mirrored) {
  cv::Mat quarters(64, 64, CV_8UC3, cv::Scalar(255, 255, 255));
  quarters(cv::Rect(0, 0, 32, 32)) = cv::Scalar(255, 0, 0);   // top left
  quarters(cv::Rect(32, 0, 32, 32)) = cv::Scalar(0, 255, 0);  // top right
  quarters(cv::Rect(0, 32, 32, 32)) = cv::Scalar(0, 0, 255);  // bottom left
  const auto image = renderer->add(make_rectangle(1, 1), quarters);
  const cv::Mat rgb = draw({at(image, 0, 0, 2)});
  EXPECT_EQ(rgb.at<cv::Vec3b>(80, 120), cv::Vec3b(255, 0, 0));
  EXPECT_EQ(rgb.at<cv::Vec3b>(80, 180), cv::Vec3b(0, 255, 0));
  EXPECT_EQ(rgb.at<cv::Vec3b>(140, 120), cv::Vec3b(0, 0, 255));
  EXPECT_EQ(rgb.at<cv::Vec3b>(140, 180), cv::Vec3b(255, 255, 255));
}

TEST_F(Drawing, what_is_nearer_hides_whatever_the_order) {
  const auto near = renderer->add(make_rectangle(0.5F, 0.5F), plain({255, 0, 0}));
  const auto far = renderer->add(make_rectangle(3, 3), plain({0, 255, 0}));
  const Item items[] = {at(near, 0, 0, 1), at(far, 0, 0, 2)};
  const cv::Mat one = draw({items[0], items[1]}), other = draw({items[1], items[0]});
  EXPECT_EQ(one.at<cv::Vec3b>(110, 150), cv::Vec3b(255, 0, 0));
  EXPECT_EQ(cv::norm(one, other, cv::NORM_INF), 0);
}

TEST_F(Drawing, the_same_is_the_same_to_the_byte_and_sizes_may_change) {
  const auto ball = renderer->add(make_ball(0.4F), plain({200, 100, 50}));
  const cv::Mat first = draw({at(ball, 0.1F, 0.1F, 2)}).clone();
  camera.width = 111;
  EXPECT_EQ(draw({at(ball, 0.1F, 0.1F, 2)}).cols, 111);
  camera.width = 320;
  EXPECT_EQ(cv::norm(first, draw({at(ball, 0.1F, 0.1F, 2)}), cv::NORM_INF), 0);
}

TEST_F(Drawing, the_number_of_a_removed_surface_is_used_again) {
  const auto small = renderer->add(make_rectangle(0.2F, 0.2F), plain({255, 0, 0}));
  const auto kept = renderer->add(make_rectangle(0.4F, 0.4F), plain({0, 255, 0}));
  renderer->remove(small);
  const cv::Mat without = draw({at(small, 0, 0, 1), at(kept, 0, 0, 2)}).clone();
  EXPECT_EQ(cv::norm(without, draw({at(kept, 0, 0, 2)}), cv::NORM_INF), 0);
  const auto large = renderer->add(make_rectangle(0.6F, 0.6F), plain({0, 0, 255}));
  EXPECT_EQ(large, small);
  const cv::Mat drawn = draw({at(large, 0, 0, 1), at(kept, 0, 0, 2)});
  EXPECT_EQ(drawn.at<cv::Vec3b>(110, 150), cv::Vec3b(0, 0, 255));
  EXPECT_EQ(drawn.at<cv::Vec3b>(110, 150 + 70), cv::Vec3b(0, 0, 255));
  EXPECT_NE(renderer->add(make_rectangle(1, 1), plain({9, 9, 9})), kept);
}

TEST_F(Drawing, an_image_that_is_too_large_is_refused) {
  camera.width = 1 << 20;
  cv::Mat rgb;
  auto drawn = renderer->draw({}, camera, T_world_camera, kFlat, rgb);
  ASSERT_FALSE(drawn);
  EXPECT_EQ(drawn.error().code, Code::Unsupported);
}

}  // namespace
}  // namespace hc::graphics
