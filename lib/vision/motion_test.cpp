// SPDX-License-Identifier: Apache-2.0
#include <vision/motion.h>

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <opencv2/imgproc.hpp>
#include <random>

namespace hc::vision {
namespace {

constexpr double kDegree = 0.017453292519943295;

Eigen::Matrix3d turned(double x, double y, double z) {
  using Eigen::AngleAxisd, Eigen::Vector3d;
  return (AngleAxisd(x, Vector3d::UnitX()) * AngleAxisd(y, Vector3d::UnitY()) *
          AngleAxisd(z, Vector3d::UnitZ()))
      .matrix();
}

double angle_between(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b) {
  return Eigen::AngleAxisd(a.transpose() * b).angle();
}

/// Points 1.5 to 5 m away, seen from two places with a little noise and some wrong matches.
Matches scene(const Eigen::Matrix3d& R_a_b, const Eigen::Vector3d& t, double noise, int wrong) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> u(0, 800), v(0, 600), depth(1.5, 5);
  std::normal_distribution<double> error(0, noise);
  const Intrinsics camera;
  Matches matches;
  while (matches.a.size() < 400) {
    const double z = depth(random), x = u(random), y = v(random);
    const Eigen::Vector3d p_a(z * (x - camera.cx) / camera.focal,
                              z * (y - camera.cy) / camera.focal, z);
    const Eigen::Vector3d p_b = R_a_b.transpose() * (p_a - t);
    if (p_b.z() < 0.2) continue;
    const double x_b = camera.focal * p_b.x() / p_b.z() + camera.cx;
    const double y_b = camera.focal * p_b.y() / p_b.z() + camera.cy;
    if (x_b < 0 || x_b > 800 || y_b < 0 || y_b > 600) continue;
    matches.a.emplace_back(float(x + error(random)), float(y + error(random)));
    matches.b.emplace_back(float(x_b + error(random)), float(y_b + error(random)));
  }
  for (int i = 0; i < wrong; ++i) matches.b[std::size_t(i)] = {float(u(random)), float(v(random))};
  return matches;
}

TEST(RelativePose, is_found_between_two_eyes_which_ever_is_the_left) {
  for (double side : {0.1, -0.1}) {
    const Eigen::Matrix3d R = turned(0.01, 0.02, -0.015);
    const auto found = relative_pose(scene(R, {side, 0.001, 0.002}, 0.15, 40), {},
                                     Eigen::Matrix3d::Identity(), Eigen::Vector3d::UnitX());
    ASSERT_TRUE(found);
    EXPECT_LT(angle_between(found->R_a_b, R), 0.1 * kDegree);
    EXPECT_GT(found->t.x() * side, 0.099);
    EXPECT_GT(found->inliers, 330U);
    EXPECT_LT(found->inliers, 400U);
  }
}

TEST(RelativePose, is_found_when_a_head_turns_its_eye_a_little_beside_its_axis) {
  const Eigen::Matrix3d R = turned(0.02, 0.5, 0.01);
  const auto found =
      relative_pose(scene(R, {0.03, 0, 0.02}, 0.15, 0), {}, turned(0, 0.48, 0), {1, 0, 0.5});
  ASSERT_TRUE(found);
  EXPECT_LT(angle_between(found->R_a_b, R), 0.1 * kDegree);
}

TEST(RelativePose, needs_matches_that_agree) {
  Matches few = scene(turned(0, 0, 0), {0.1, 0, 0}, 0.1, 0);
  few.a.resize(20);
  few.b.resize(20);
  EXPECT_FALSE(relative_pose(few, {}, turned(0, 0, 0), {1, 0, 0}));
  EXPECT_FALSE(relative_pose({}, {}, turned(0, 0, 0), {1, 0, 0}));
  EXPECT_FALSE(match(cv::Mat(60, 80, CV_8U, cv::Scalar(9)), cv::Mat(60, 80, CV_8U, cv::Scalar(9)),
                     {}, turned(0, 0, 0))
                   .a.size() > 0);
}

TEST(Match, follows_points_through_a_turn) {
  cv::Mat coarse(60, 80, CV_8U), image;
  cv::RNG(5).fill(coarse, cv::RNG::UNIFORM, 0, 255);
  cv::resize(coarse, image, {800, 600}, 0, 0, cv::INTER_CUBIC);
  const Intrinsics camera;
  const Eigen::Matrix3d R = turned(0.05, 0.3, 0.02);
  Eigen::Matrix3d K;
  K << camera.focal, 0, camera.cx, 0, camera.focal, camera.cy, 0, 0, 1;
  const Eigen::Matrix3d H_b_a = K * R.transpose() * K.inverse();
  cv::Mat other, h(3, 3, CV_64F);
  for (int i = 0; i < 9; ++i) h.at<double>(i / 3, i % 3) = H_b_a(i / 3, i % 3);
  cv::warpPerspective(image, other, h, image.size(), cv::INTER_CUBIC);
  const auto matches = match(image, other, camera, turned(0.04, 0.29, 0.02));  // 1 degree off
  ASSERT_GT(matches.a.size(), 100U);
  double sum = 0;
  for (std::size_t i = 0; i < matches.a.size(); ++i) {
    const Eigen::Vector3d p = H_b_a * Eigen::Vector3d(matches.a[i].x, matches.a[i].y, 1);
    sum += cv::norm(matches.b[i] - cv::Point2f(float(p.x() / p.z()), float(p.y() / p.z())));
  }
  EXPECT_LT(sum / double(matches.a.size()), 0.3);
}

}  // namespace
}  // namespace hc::vision
