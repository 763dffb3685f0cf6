// SPDX-License-Identifier: Apache-2.0
#include <people/pointing.h>

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include <Eigen/Geometry>

namespace hc::people {
namespace {

using Eigen::Vector3d;

const vision::Pinhole kLens{600, 600, 399.5, 299.5};

/// A depth image of 800 × 600 pixels. @param depth_at  along a direction (x, y, 1) [m], 0 unknown.
cv::Mat depth_image(const std::function<double(const Vector3d&)>& depth_at) {
  cv::Mat depth(600, 800, CV_32F);
  for (int y = 0; y < depth.rows; ++y)
    for (int x = 0; x < depth.cols; ++x)
      depth.at<float>(y, x) =
          static_cast<float>(depth_at({(x - kLens.cx) / kLens.fx, (y - kLens.cy) / kLens.fy, 1}));
  return depth;
}
cv::Mat wall(double distance) {
  return depth_image([=](const Vector3d&) { return distance; });
}
/// A plane n · p = d.
cv::Mat plane(const Vector3d& n, double d) {
  return depth_image([=](const Vector3d& ray) {
    const double z = d / n.dot(ray);
    return z > 0 && z < 20 ? z : 0;
  });
}

Ray ray(const Vector3d& from, const Vector3d& to) {
  return {from, (to - from).normalized()};
}

/// A hand whose index finger lies between two points.
Joints pointing(const Vector3d& knuckle, const Vector3d& tip) {
  Joints joints;
  joints.fill(knuckle);
  joints[Hand::IndexTip] = tip;
  return joints;
}

TEST(PointingRay, is_the_fingers_direction_without_an_eye) {
  const Ray finger = pointing_ray(pointing({0, 0, 1}, {0.1, 0, 1}), std::nullopt);
  EXPECT_TRUE(finger.from.isApprox(Vector3d(0.1, 0, 1)));
  EXPECT_TRUE(finger.direction.isApprox(Vector3d::UnitX()));
  EXPECT_FALSE(finger.is_from_eye);
}

TEST(PointingRay, goes_from_the_eye_through_the_tip) {
  const Ray aimed = pointing_ray(pointing({0, 0, 1}, {0.1, 0, 1}), Vector3d(-0.4, -0.2, 1.1));
  EXPECT_TRUE(aimed.direction.isApprox(Vector3d(0.5, 0.2, -0.1).normalized()));
  EXPECT_TRUE(aimed.is_from_eye);
}

TEST(PointingRay, is_the_fingers_where_it_is_pointed_from_the_hip) {
  const Ray hip = pointing_ray(pointing({0, 0, 1}, {0.1, 0, 1}), Vector3d(0, -0.6, 1));
  EXPECT_TRUE(hip.direction.isApprox(Vector3d::UnitX()));
  EXPECT_FALSE(hip.is_from_eye);
}

TEST(PlacePointedAt, is_on_a_wall_or_a_floor_in_any_direction) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> any(-1, 1);
  const struct {
    Vector3d n;
    double d;
  } planes[] = {{{0, 0, 1}, 3}, {{0, 1, 0}, 1.1}, {{0.5, 0.1, 1}, 2.5}, {{0, 0.8, 1}, 2.2}};
  int hits = 0;
  for (const auto& [n, d] : planes) {
    const cv::Mat depth = plane(n, d);
    for (int i = 0; i < 100; ++i) {
      const Vector3d tip(0.3 * any(random), 0.2 * any(random), 1 + 0.2 * any(random));
      const Ray to = ray(tip, tip + Vector3d(any(random), any(random), any(random)));
      const double length = (d - n.dot(tip)) / n.dot(to.direction);  // closed form
      const Vector3d truth = to.from + length * to.direction;
      const double u = kLens.fx * truth.x() / truth.z(), v = kLens.fy * truth.y() / truth.z();
      const bool is_seen =
          length > 0.3 && length < 10 && truth.z() > 0.05 && std::abs(u) < 398 && std::abs(v) < 298;
      const auto place = place_pointed_at(to, depth, kLens);
      EXPECT_EQ(place.has_value(), is_seen) << n.transpose() << ", " << truth.transpose();
      if (!place || !is_seen) continue;
      ++hits;
      // A pixel of the surface, seen at a slant.
      const double slant = std::abs(n.dot(truth.normalized())) / n.norm();
      EXPECT_LT((*place - truth).norm(), 0.02 + 0.004 * truth.z() / slant) << truth.transpose();
    }
  }
  EXPECT_GT(hits, 40);
}

TEST(PlacePointedAt, is_on_the_first_thing) {
  // A ball of 0.3 m at (0.5, 0, 2), before a wall.
  const Vector3d middle(0.5, 0, 2);
  const cv::Mat depth = depth_image([&](const Vector3d& to) {
    const double a = to.squaredNorm(), b = to.dot(middle), c = middle.squaredNorm() - 0.09;
    const double root = b * b - a * c;
    return root > 0 ? (b - std::sqrt(root)) / a : 4.0;
  });
  const auto place = place_pointed_at(ray({-0.3, 0.1, 1}, {0.4, 0, 1.8}), depth, kLens);
  ASSERT_TRUE(place);
  EXPECT_NEAR((*place - middle).norm(), 0.3, 0.01);
  const auto past = place_pointed_at(ray({-0.3, 0.1, 1}, {-0.3, 0, 1.8}), depth, kLens);
  ASSERT_TRUE(past);
  EXPECT_NEAR(past->z(), 4, 0.01);
}

TEST(PlacePointedAt, is_not_on_the_hand_itself) {
  cv::Mat depth = wall(3);
  depth(cv::Rect(370, 270, 100, 60)) = 0.95F;  // hand and arm around the tip, up to (0.1, 0, 1)
  const auto place = place_pointed_at(ray({0.1, 0, 1}, {0.7, 0, 3}), depth, kLens);
  ASSERT_TRUE(place);
  EXPECT_NEAR(place->x(), 0.7, 0.01);
  EXPECT_NEAR(place->z(), 3, 0.01);
}

TEST(PlacePointedAt, is_behind_what_hides_a_part_of_the_ray) {
  cv::Mat depth = wall(3);
  depth(cv::Rect(420, 0, 60, 600)) = 0.5F;  // a pole before the hand
  const auto place = place_pointed_at(ray({0, 0, 1}, {1.2, 0, 3}), depth, kLens);
  ASSERT_TRUE(place);
  EXPECT_NEAR(place->x(), 1.2, 0.01);
}

TEST(PlacePointedAt, is_found_beyond_pixels_without_depth) {
  cv::Mat depth = wall(3);
  depth(cv::Rect(450, 0, 100, 600)) = 0;
  const auto place = place_pointed_at(ray({0, 0, 1}, {1.5, 0, 3}), depth, kLens);
  ASSERT_TRUE(place);
  EXPECT_NEAR(place->x(), 1.5, 0.01);
}

TEST(PlacePointedAt, is_on_no_pixel_whose_depth_is_not_a_number) {
  for (const float none : {INFINITY, -INFINITY, NAN}) {
    cv::Mat depth = wall(2);
    depth.colRange(0, 400) = none;
    const auto place = place_pointed_at(ray({-0.5, 0, 1}, {0.5, 0, 2.2}), depth, kLens);
    ASSERT_TRUE(place) << none;
    EXPECT_NEAR(place->z(), 2, 0.01) << none;
    EXPECT_FALSE(place_pointed_at(ray({-0.5, 0, 1}, {-0.4, 0, 2}), depth, kLens)) << none;
  }
}

TEST(PlacePointedAt, is_found_soon_with_any_focal_length) {
  const auto place =
      place_pointed_at({{0, 0, 1}, Vector3d::UnitZ(), false}, wall(2), {1e14, 1e14, 399.5, 299.5});
  ASSERT_TRUE(place);
  EXPECT_NEAR(place->z(), 2, 0.01);
}

TEST(PlacePointedAt, is_none_where_the_ray_leaves_what_is_seen) {
  const cv::Mat depth = wall(3);
  EXPECT_FALSE(place_pointed_at(ray({0, 0, 1}, {5, 0, 1.5}), depth, kLens)) << "to the side";
  EXPECT_FALSE(place_pointed_at(ray({0, 0, 1}, {0, 0, 0}), depth, kLens)) << "to the camera";
  EXPECT_FALSE(place_pointed_at(ray({0, 0, 1}, {0, 0, 3}), wall(0), kLens)) << "unknown";
  EXPECT_FALSE(place_pointed_at(ray({0, 0, 1}, {0, 0, 3}), cv::Mat(), kLens));
  EXPECT_FALSE(place_pointed_at(ray({0, 0, 1}, {0, 0, 3}), depth, kLens, {.last = 1.5}));
}

}  // namespace
}  // namespace hc::people
