// SPDX-License-Identifier: Apache-2.0
#include <vision/rectifier.h>

#include <gtest/gtest.h>

#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

namespace hc::vision {
namespace {

cv::Mat noise(cv::Size size) {
  cv::Mat image(size, CV_8UC3);
  cv::RNG(4).fill(image, cv::RNG::UNIFORM, 0, 256);
  return image;
}

TEST(Rectifier, AnIdealPairStaysAsItIs) {
  const auto ideal = ideal_pair({64, 48}, 50, 0.1);
  EXPECT_DOUBLE_EQ(ideal.baseline(), 0.1);
  EXPECT_DOUBLE_EQ(ideal.rectified().cx, 31.5);
  const cv::Mat image = noise({64, 48});
  for (Eye eye : {Eye::Left, Eye::Right}) {
    auto rectifier = Rectifier::make(ideal, eye, {64, 48});
    ASSERT_TRUE(rectifier);
    cv::Mat rectified(48, 64, CV_8UC3);
    const auto* place = rectified.data;
    rectifier->rectify(image, rectified);
    EXPECT_EQ(rectified.data, place) << "in place";
    EXPECT_EQ(cv::norm(image, rectified, cv::NORM_INF), 0);
  }
}

// Draws discs on a wall as seen by two squinting cameras with distortion.
TEST(Rectifier, RowsCorrespondAndDisparityIsDepth) {
  StereoCalibration c = ideal_pair({800, 600}, 600, 0.1);
  c.D1 = {-0.2, 0.05, 0.001, 0, 0};
  c.D2 = {-0.15, 0.03, 0, 0.001, 0};
  cv::Rodrigues(cv::Vec3d(0.02, 0.06, -0.03), c.R);
  c.T = {-0.1, 0.003, 0.002};
  rectify(c);
  cv::Vec3d turn;
  cv::Rodrigues(c.R, turn);
  auto left = Rectifier::make(c, Eye::Left, c.size), right = Rectifier::make(c, Eye::Right, c.size);
  ASSERT_TRUE(left && right);
  for (const cv::Point3d place : {cv::Point3d(0, 0, 1.5), {-0.3, 0.25, 1.5}, {0.4, -0.3, 2}}) {
    double x[2], y[2];
    for (int side : {0, 1}) {
      std::vector<cv::Point2d> at;
      const bool is_left = side == 0;
      cv::projectPoints(std::vector<cv::Point3d>{place}, is_left ? cv::Vec3d() : turn,
                        is_left ? cv::Vec3d() : c.T, is_left ? c.M1 : c.M2, is_left ? c.D1 : c.D2,
                        at);
      cv::Mat image = cv::Mat::zeros(c.size, CV_8U), rectified;
      constexpr int kShift = 6;
      cv::circle(image, cv::Point2d(at[0] * (1 << kShift)), 12 << kShift, 255, cv::FILLED,
                 cv::LINE_AA, kShift);
      (is_left ? left : right)->rectify(image, rectified);
      const auto m = cv::moments(rectified);
      ASSERT_GT(m.m00, 0);
      x[side] = m.m10 / m.m00;
      y[side] = m.m01 / m.m00;
    }
    EXPECT_NEAR(y[0], y[1], 0.15) << "px";
    const double z = (c.R1 * cv::Vec3d(place.x, place.y, place.z))[2];
    EXPECT_NEAR(c.rectified().fx * c.baseline() / (x[0] - x[1]), z, 0.01 * z) << "m";
    const cv::Vec4d q = c.Q * cv::Vec4d(x[0], y[0], x[0] - x[1], 1);
    EXPECT_NEAR(q[2] / q[3], z, 0.01 * z) << "m, by Q";
  }
}

TEST(Rectifier, AnotherSizeIsRefused) {
  auto made = Rectifier::make(ideal_pair({800, 600}, 600, 0.1), Eye::Left, {640, 480});
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().detail, "an image of 640 x 480, the calibration is for 800 x 600");
  auto ideal = ideal_pair({800, 600}, 600, 0.1);
  ideal.size = {};  // unknown
  EXPECT_TRUE(Rectifier::make(ideal, Eye::Right, {640, 480}));
  EXPECT_EQ(Rectifier::make(ideal, Eye::Left, {40000, 1}).error().code, Code::TooLarge);
  EXPECT_EQ(Rectifier::make(ideal, Eye::Left, {0, 0}).error().code, Code::TooLarge);
}

}  // namespace
}  // namespace hc::vision
