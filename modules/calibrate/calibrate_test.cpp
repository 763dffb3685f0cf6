// SPDX-License-Identifier: Apache-2.0
#include "calibrate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include <Eigen/Geometry>
#include <opencv2/imgproc.hpp>

namespace {

using Eigen::AngleAxisd;
using Eigen::Vector3d;

constexpr double kDegree = M_PI / 180;

/// A world of bright discs, drawn as an eye of the head sees them.
class Discs {
 public:
  Discs() {
    std::mt19937 random(4);
    std::uniform_real_distribution<double> pan(-1.2, 1.2), tilt(-0.9, 0.9), range(1.8, 5),
        grey(60, 255), size(0.01, 0.025);
    for (int i = 0; i < 2500; ++i) {
      const double r = range(random);
      discs_.push_back({hc::gaze::rotation({pan(random), tilt(random)}) * Vector3d(r, 0, 0),
                        size(random), grey(random)});
    }
  }

  /// @param T_robot_eye  optical.
  [[nodiscard]] cv::Mat seen_from(const Eigen::Isometry3d& T_robot_eye) const {
    const hc::vision::Intrinsics camera;
    cv::Mat picture(600, 800, CV_8U, cv::Scalar(20));
    constexpr int kShift = 8;  // fractions of a pixel
    for (const auto& disc : discs_) {
      const Vector3d p = T_robot_eye.inverse() * disc.place;
      if (p.z() < 0.3) continue;
      const cv::Point middle(
          static_cast<int>((camera.focal * p.x() / p.z() + camera.cx) * (1 << kShift)),
          static_cast<int>((camera.focal * p.y() / p.z() + camera.cy) * (1 << kShift)));
      cv::circle(picture, middle,
                 static_cast<int>(disc.radius * camera.focal / p.z() * (1 << kShift)),
                 cv::Scalar(disc.grey), cv::FILLED, cv::LINE_AA, kShift);
    }
    return picture;
  }

 private:
  struct Disc {
    Vector3d place;
    double radius, grey;
  };
  std::vector<Disc> discs_;
};

TEST(Calibrate, finds_how_the_eyes_sit_and_which_is_the_left) {
  const Discs discs;
  Eigen::Matrix3d optical;
  optical << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  const Vector3d middle(0.06, 0, 0.05);
  const Eigen::Matrix3d zero = hc::gaze::rotation({2 * kDegree, -1.5 * kDegree}).matrix();
  const Eigen::Matrix3d offset =
      AngleAxisd(0.8 * kDegree, Vector3d(1, 0.5, -0.7).normalized()).matrix();
  for (bool swapped : {false, true}) {
    std::vector<HeadView> views;
    for (const hc::gaze::Angles& unit : {hc::gaze::Angles{0, 0},
                                         {0.25, 0},
                                         {-0.25, 0},
                                         {0, 0.125},
                                         {0, -0.125},
                                         {0.12, 0.12},
                                         {-0.12, -0.12}}) {
      auto eye = [&](double left, const Eigen::Matrix3d& turned) {
        return discs.seen_from(
            hc::gaze::rotation(unit) *
            (Eigen::Isometry3d(zero) * Eigen::Translation3d(middle + Vector3d(0, left, 0)) *
             Eigen::Isometry3d(optical * turned)));
      };
      const cv::Mat one = eye(0.05, Eigen::Matrix3d::Identity()), other = eye(-0.05, offset);
      views.push_back({unit, swapped ? other : one, swapped ? one : other});
    }
    const auto found = calibrate(views, {}, middle, 0.1);
    ASSERT_TRUE(found) << found.error().text();
    EXPECT_EQ(found->swapped, swapped);
    EXPECT_NEAR(found->zero.pan / kDegree, 2, 0.1);
    EXPECT_NEAR(found->zero.tilt / kDegree, -1.5, 0.1);
    const Vector3d turn = 0.8 * Vector3d(1, 0.5, -0.7).normalized();
    EXPECT_NEAR(found->offset_pitch / kDegree, turn.x(), 0.1);
    EXPECT_NEAR(found->offset_yaw / kDegree, turn.y(), 0.1);
    EXPECT_NEAR(found->offset_roll / kDegree, turn.z(), 0.1);
  }
}

TEST(Calibrate, says_when_too_little_is_seen) {
  const cv::Mat dark(600, 800, CV_8U, cv::Scalar(0));
  const auto found = calibrate({{{0, 0}, dark, dark}, {{0.2, 0}, dark, dark}}, {}, {0, 0, 0}, 0.1);
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().detail, "too little is seen in both pictures of the eyes");
}

}  // namespace
