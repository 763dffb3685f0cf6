// SPDX-License-Identifier: Apache-2.0
#include "calibrate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include <gaze/mounted_eyes_test.h>
#include <vision/motion.h>
#include <Eigen/Geometry>
#include <opencv2/imgproc.hpp>

namespace {

using Eigen::AngleAxisd;
using Eigen::Vector3d;

constexpr double kDegree = M_PI / 180;

/// A world of bright discs, rendered for an eye of the head.
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
    cv::Mat image(600, 800, CV_8U, cv::Scalar(20));
    constexpr int kShift = 8;  // fractions of a pixel
    for (const auto& disc : discs_) {
      const Vector3d p = T_robot_eye.inverse() * disc.place;
      if (p.z() < 0.3) continue;
      const cv::Point middle(
          static_cast<int>((camera.focal * p.x() / p.z() + camera.cx) * (1 << kShift)),
          static_cast<int>((camera.focal * p.y() / p.z() + camera.cy) * (1 << kShift)));
      cv::circle(image, middle,
                 static_cast<int>(disc.radius * camera.focal / p.z() * (1 << kShift)),
                 cv::Scalar(disc.grey), cv::FILLED, cv::LINE_AA, kShift);
    }
    return image;
  }

 private:
  struct Disc {
    Vector3d place;
    double radius, grey;
  };
  std::vector<Disc> discs_;
};

/// A head that deviates from its design, and its images.
struct Crooked {
  hc::gaze::Eyes mounted = hc::gaze::mounted_eyes();
  hc::gaze::Angles zero{2 * kDegree, -1.5 * kDegree};
  Vector3d offset = 0.8 * kDegree * Vector3d(1, 0.5, -0.7).normalized();
  Eigen::Matrix3d R_left_right = AngleAxisd(offset.norm(), offset.normalized()).matrix();
  hc::vision::StereoCalibration pair = hc::vision::ideal_pair({800, 600}, 600, 0.1);

  [[nodiscard]] std::vector<HeadView> views(bool swapped) const {
    const Discs discs;
    std::vector<HeadView> views;
    for (const hc::gaze::Angles& unit : {hc::gaze::Angles{0, 0},
                                         {0.25, 0},
                                         {-0.25, 0},
                                         {0, 0.125},
                                         {0, -0.125},
                                         {0.12, 0.12},
                                         {-0.12, -0.12}}) {
      auto eye = [&](hc::gaze::Side side, const Eigen::Matrix3d& turned) {
        return discs.seen_from(hc::gaze::rotation(unit) *
                               (Eigen::Isometry3d(hc::gaze::rotation(zero)) *
                                mounted.T_head_eye(side) * Eigen::Isometry3d(turned)));
      };
      const cv::Mat one = eye(hc::gaze::Side::Left, Eigen::Matrix3d::Identity());
      const cv::Mat other = eye(hc::gaze::Side::Right, R_left_right);
      views.push_back({unit, swapped ? other : one, swapped ? one : other});
    }
    return views;
  }

  void expect_found(const hc::Result<hc::gaze::HeadCalibration>& found) const {
    ASSERT_TRUE(found) << found.error().text();
    EXPECT_NEAR((found->zero.pan - zero.pan) / kDegree, 0, 0.1);
    EXPECT_NEAR((found->zero.tilt - zero.tilt) / kDegree, 0, 0.1);
    EXPECT_NEAR((found->offset - offset).norm() / kDegree, 0, 0.15);
  }
};

TEST(Calibrate, finds_how_the_eyes_sit_and_which_is_the_left) {
  const Crooked head;
  for (bool swapped : {false, true}) {
    const auto found = calibrate(head.views(swapped), head.pair, head.mounted);
    head.expect_found(found);
    EXPECT_EQ(found->swapped, swapped);
  }
}

TEST(Calibrate, a_pose_that_shows_little_is_dropped) {
  const Crooked head;
  auto views = head.views(false);
  views[4].second.setTo(0);
  head.expect_found(calibrate(views, head.pair, head.mounted));
  // But at least one tilted view must remain.
  views.resize(4);
  views[3].second.setTo(0);
  const auto found = calibrate(views, head.pair, head.mounted);
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().detail, "too few matches between the images as the head turns");
}

TEST(Calibrate, a_pair_that_was_measured_is_not_measured_worse) {
  const Crooked head;
  const auto views = head.views(false);
  auto measured = head.pair;
  measured.rms = 0.2;
  auto turned = [&](double yaw) {
    return Eigen::Matrix3d(head.R_left_right *
                           AngleAxisd(yaw, Vector3d::UnitY()).toRotationMatrix());
  };
  hc::vision::turn(measured, turned(0.15 * kDegree));
  const auto found = calibrate(views, measured, head.mounted);
  ASSERT_TRUE(found);
  EXPECT_NEAR((found->R_left_right() - turned(0.15 * kDegree)).norm(), 0, 1e-9);
  // One that has moved since is measured again.
  hc::vision::turn(measured, turned(2 * kDegree));
  head.expect_found(calibrate(views, measured, head.mounted));
}

TEST(Calibrate, ends_when_it_is_asked_to) {
  cv::Mat image(600, 800, CV_8U);
  cv::RNG(1).fill(image, cv::RNG::UNIFORM, 0, 256);
  cv::GaussianBlur(image, image, {}, 2);
  std::stop_source stop;
  stop.request_stop();
  const auto found = calibrate({{{0, 0}, image, image}, {{0.2, 0}, image, image}},
                               hc::vision::ideal_pair({800, 600}, 600, 0.1),
                               hc::gaze::mounted_eyes(), stop.get_token());
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().code, hc::Code::Stopped);
}

TEST(Calibrate, says_when_too_little_is_seen) {
  const cv::Mat dark(600, 800, CV_8U, cv::Scalar(0));
  const auto pair = hc::vision::ideal_pair({800, 600}, 600, 0.1);
  const std::vector<HeadView> views = {{{0, 0}, dark, dark}, {{0.2, 0}, dark, dark}};
  auto found = calibrate(views, pair, hc::gaze::mounted_eyes());
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().detail, "too few matches between the images of the eyes");
  found = calibrate(views, hc::vision::ideal_pair({640, 480}, 600, 0.1), hc::gaze::mounted_eyes());
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().detail, "the cameras' calibration is for images of 640 x 480");
}

}  // namespace
