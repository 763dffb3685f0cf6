// SPDX-License-Identifier: Apache-2.0
#include <vision/image.h>
#include <vision/marker.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>

#include <vision/marker_finder.h>
#include <opencv2/aruco.hpp>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

extern "C" {
#include <apriltag/apriltag.h>
#include <apriltag/tag36h11.h>
}

#include <hc/testing/must.h>

namespace hc::vision {
namespace {

constexpr double kSide = 0.16;  // [m]
const Camera kCamera{{600, 600, 399.5, 299.5}, {}};

/// An image of a marker's face, kPixels for each of its cells, with a margin of a cell.
struct Face {
  cv::Mat rgb;
  double margin = 0, side = 0;  // [px]
};

Face face_of(MarkerKind kind, int id) {
  if (kind == MarkerKind::Colour) {
    cv::Mat rgb(480, 480, CV_8UC3, cv::Scalar::all(240));
    cv::Mat hsv(1, 1, CV_8UC3, cv::Scalar(id / 2.0, 225, 200)), colour;
    cv::cvtColor(hsv, colour, cv::COLOR_HSV2RGB);
    const auto c = colour.at<cv::Vec3b>(0, 0);
    rgb(cv::Rect(80, 80, 320, 320)) = cv::Scalar(c[0], c[1], c[2]);
    return {rgb, 80, 320};
  }
  if (kind == MarkerKind::AprilTag) {
    // From the AprilTag library, rotated by 180° relative to OpenCV; with a margin.
    apriltag_family_t* family = tag36h11_create();
    image_u8_t* tag = apriltag_to_image(family, id);
    cv::Mat grey, rgb;
    cv::resize(
        cv::Mat(tag->height, tag->width, CV_8U, tag->buf, static_cast<std::size_t>(tag->stride)),
        grey, {400, 400}, 0, 0, cv::INTER_NEAREST);
    std::free(tag->buf);  // image_u8_destroy() is not exported
    std::free(tag);
    tag36h11_destroy(family);
    cv::cvtColor(grey, rgb, cv::COLOR_GRAY2RGB);
    return {rgb, 40, 320};
  }
  const auto words = cv::aruco::getPredefinedDictionary(cv::aruco::DICT_6X6_250);
  // cv::Ptr and drawMarker in OpenCV 4.6, a value and generateImageMarker since 4.7.
  cv::Mat code = [&](const auto& dictionary) {
    cv::Mat image;
    if constexpr (requires { dictionary.get(); })
      dictionary->drawMarker(id, 320, image, 1);
    else
      dictionary.generateImageMarker(id, 320, image, 1);
    return image;
  }(words);
  cv::Mat grey, rgb;
  cv::copyMakeBorder(code, grey, 40, 40, 40, 40, cv::BORDER_CONSTANT, 255);
  cv::cvtColor(grey, rgb, cv::COLOR_GRAY2RGB);
  return {rgb, 40, 320};
}

struct Truth {
  cv::Matx33d R;
  cv::Vec3d t;
};

/// A camera's image of a marker, rendered at four times the size and averaged.
cv::Mat view(const Face& face, const Truth& truth, const Camera& camera, double noise) {
  constexpr int kFine = 4;
  const auto& p = camera.pinhole;
  const cv::Matx33d M(kFine * p.fx, 0, kFine * (p.cx + 0.5) - 0.5, 0, kFine * p.fy,
                      kFine * (p.cy + 0.5) - 0.5, 0, 0, 1);
  // A face's pixel (u, v) is at ((u + 0.5 - margin) / side − 0.5) · kSide.
  const double scale = kSide / face.side, shift = (0.5 - face.margin) * scale - kSide / 2;
  const cv::Matx33d plane(scale, 0, shift, 0, scale, shift, 0, 0, 1);
  cv::Matx33d pose = truth.R;
  for (int row = 0; row < 3; ++row) pose(row, 2) = truth.t[row];
  cv::Mat fine, image;
  cv::warpPerspective(face.rgb, fine, M * pose * plane, {800 * kFine, 600 * kFine},
                      cv::INTER_LINEAR, cv::BORDER_CONSTANT, cv::Scalar(120, 125, 130));
  cv::resize(fine, image, {800, 600}, 0, 0, cv::INTER_AREA);
  cv::GaussianBlur(image, image, {3, 3}, 0.7);
  if (noise > 0) {
    cv::Mat error(image.size(), CV_16SC3), sum;
    cv::RNG(5).fill(error, cv::RNG::NORMAL, 0, noise);
    image.convertTo(sum, CV_16S);
    sum += error;
    sum.convertTo(image, CV_8U);
  }
  return image;
}

Truth truth_at(double x, double y, double z, double pitch, double yaw, double roll) {
  cv::Matx33d a, b, c;
  cv::Rodrigues(cv::Vec3d(pitch, 0, 0), a);
  cv::Rodrigues(cv::Vec3d(0, yaw, 0), b);
  cv::Rodrigues(cv::Vec3d(0, 0, roll), c);
  return {a * b * c, {x, y, z}};
}

double angle(const cv::Matx33d& a, const cv::Matx33d& b) {
  cv::Vec3d turn;
  cv::Rodrigues(a.t() * b, turn);
  return cv::norm(turn) * 180 / std::numbers::pi;
}

std::vector<Marker> find(MarkerKind kind, const cv::Mat& image) {
  static const auto aruco = ArucoFinder::make("6X6_250");
  static const AprilTagFinder apriltag(1);
  if (kind == MarkerKind::Aruco) return aruco->find(grey_of(image));
  if (kind == MarkerKind::AprilTag) return apriltag.find(grey_of(image));
  return find_colour_markers(image);
}

class EachKind : public testing::TestWithParam<std::pair<MarkerKind, int>> {};

TEST_P(EachKind, IsFoundWhereItIs) {
  const auto [kind, id] = GetParam();
  const Face face = face_of(kind, id);
  std::vector<double> far, turned;
  for (const auto& truth :
       {truth_at(0, 0, 1, 0.3, 0.4, 0.1), truth_at(0.2, -0.1, 1.5, -0.4, 0.3, -0.2),
        truth_at(-0.5, 0.3, 2, 0.5, -0.5, 0.3), truth_at(-0.1, 0.2, 0.6, 0.2, -0.3, 0),
        truth_at(0.3, 0.3, 1.2, -0.5, -0.4, -0.3), truth_at(0.6, -0.4, 2.5, 0.1, 0.7, 0.2)})
    for (double noise : {0.0, 6.0}) {
      auto found = find(kind, view(face, truth, kCamera, noise));
      ASSERT_EQ(found.size(), 1) << truth.t << ", noise " << noise;
      EXPECT_EQ(found[0].kind, kind);
      EXPECT_NEAR(found[0].id, id, kind == MarkerKind::Colour ? 6 : 0);
      auto pose = must(pose_of(found[0], kSide, kCamera));
      EXPECT_LT(pose.error, 0.5) << "px";
      far.push_back(cv::norm(pose.t - truth.t) / cv::norm(truth.t));
      turned.push_back(angle(pose.R, truth.R));
      EXPECT_LT(far.back(), 0.02) << "of the distance, at " << truth.t << ", noise " << noise;
      EXPECT_LT(turned.back(), 5) << "degrees, at " << truth.t << ", noise " << noise;
    }
  std::sort(far.begin(), far.end());
  std::sort(turned.begin(), turned.end());
  EXPECT_LT(far[far.size() / 2], 0.005) << "of the distance";
  EXPECT_LT(turned[turned.size() / 2], 1) << "degrees";
  std::printf("[          ] median %.2f %% of the distance, %.2f degrees; worst %.2f %%, %.2f\n",
              100 * far[far.size() / 2], turned[turned.size() / 2], 100 * far.back(),
              turned.back());
}

INSTANTIATE_TEST_SUITE_P(Kinds, EachKind,
                         testing::Values(std::pair{MarkerKind::Aruco, 23},
                                         std::pair{MarkerKind::AprilTag, 7},
                                         std::pair{MarkerKind::Colour, 300},
                                         std::pair{MarkerKind::Colour, 180},
                                         std::pair{MarkerKind::Colour, 120}));

TEST(Marker, ItsFrameIsAsSeenByWhoLooksAtIt) {
  Marker marker;
  marker.corners = {{{349.5, 249.5}, {449.5, 249.5}, {449.5, 349.5}, {349.5, 349.5}}};
  auto pose = must(pose_of(marker, 0.1, kCamera));
  EXPECT_LT(angle(pose.R, cv::Matx33d::eye()), 0.1);
  EXPECT_LT(cv::norm(pose.t - cv::Vec3d(0, 0, 0.6)), 1e-4);
  EXPECT_NEAR(marker.mean_side(), 100, 1e-9);
  EXPECT_LT(pose.error, 1e-3);
}

TEST(Marker, DistortionIsUndone) {
  Camera bent = kCamera;
  bent.distortion = {-0.25, 0.08, 0.001, -0.001, 0};
  const auto truth = truth_at(0.5, -0.35, 1.2, 0.3, -0.4, 0.2);
  const double h = kSide / 2;
  const std::vector<cv::Point3d> square = {{-h, -h, 0}, {h, -h, 0}, {h, h, 0}, {-h, h, 0}};
  std::vector<cv::Point2d> seen;
  cv::Vec3d turn;
  cv::Rodrigues(truth.R, turn);
  cv::projectPoints(square, turn, truth.t, cv::Matx33d(600, 0, 399.5, 0, 600, 299.5, 0, 0, 1),
                    bent.distortion, seen);
  Marker marker;
  std::copy_n(seen.begin(), 4, marker.corners.begin());
  auto pose = must(pose_of(marker, kSide, bent));
  EXPECT_LT(cv::norm(pose.t - truth.t), 1e-4);
  EXPECT_LT(angle(pose.R, truth.R), 0.05);
}

TEST(Marker, WhatIsNoSquareHasNoPoseOrAnError) {
  Marker marker;
  marker.corners = {{{100, 100}, {100, 100}, {100, 100}, {100, 100}}};
  auto pose = pose_of(marker, 0.1, kCamera);
  EXPECT_TRUE(!pose || std::isfinite(pose->error));
  marker.corners = {{{0, 0}, {NAN, 0}, {1, 1}, {0, 1}}};
  EXPECT_FALSE(pose_of(marker, 0.1, kCamera));
}

TEST(ColourMarker, OtherThingsAreNone) {
  cv::Mat image(600, 800, CV_8UC3, cv::Scalar::all(235));
  cv::circle(image, {200, 200}, 60, {210, 20, 210}, cv::FILLED, cv::LINE_AA);
  cv::rectangle(image, {400, 100, 300, 20}, {210, 20, 210}, cv::FILLED);
  cv::ellipse(image, {600, 400}, {80, 50}, 30, 0, 360, {20, 190, 20}, cv::FILLED);
  const std::vector<cv::Point> triangle = {{100, 400}, {220, 400}, {160, 520}};
  cv::fillConvexPoly(image, triangle, {20, 190, 20});
  EXPECT_TRUE(find_colour_markers(image).empty());
  // A square, but on a dark ground and on a coloured one.
  cv::Mat dark(300, 300, CV_8UC3, cv::Scalar::all(40)),
      tinted(300, 300, CV_8UC3, cv::Scalar(230, 230, 90));
  for (auto* ground : {&dark, &tinted})
    cv::rectangle(*ground, {100, 100, 80, 80}, {210, 20, 210}, cv::FILLED);
  EXPECT_TRUE(find_colour_markers(dark).empty());
  EXPECT_TRUE(find_colour_markers(tinted).empty());
  EXPECT_TRUE(find_colour_markers(cv::Mat::zeros(3, 3, CV_8UC3)).empty());
}

/// A face on a dark ground: its margin white, or with a printed frame in it.
Face framed(int id, bool has_frame) {
  Face face = face_of(MarkerKind::Aruco, id);
  constexpr int kWide = 80;
  cv::copyMakeBorder(face.rgb, face.rgb, kWide, kWide, kWide, kWide, cv::BORDER_CONSTANT,
                     has_frame ? cv::Scalar::all(255) : cv::Scalar::all(110));
  face.margin += kWide;
  if (has_frame)
    cv::rectangle(face.rgb, {50, 50, face.rgb.cols - 100, face.rgb.rows - 100}, {20, 20, 20}, 20);
  return face;
}

TEST(Aruco, CornersAreRightAtEverySizeWithAndWithoutAFrame) {
  for (const bool has_frame : {false, true})
    for (const double side : {22.0, 34.0, 50.0, 80.0, 140.0, 220.0, 300.0}) {  // [px]
      for (int i = 0; i < 3; ++i) {
        const int id = 17 * i + 3;
        const double z = kCamera.pinhole.fx * kSide / side;
        const auto truth = truth_at(0.0007 * i, 0.0011 * i, z, 0.1, -0.2, 0.5 - 0.4 * i);
        const Face face = framed(id, has_frame);
        const auto found = find(MarkerKind::Aruco, view(face, truth, kCamera, 2));
        ASSERT_EQ(found.size(), 1) << side << " px, frame " << has_frame << ", id " << id;
        EXPECT_EQ(found[0].id, id);
        for (std::size_t k = 0; k < 4; ++k) {
          const double right = k == 1 || k == 2 ? 0.5 : -0.5, down = k >= 2 ? 0.5 : -0.5;
          const cv::Vec3d at = truth.R * cv::Vec3d(kSide * right, kSide * down, 0) + truth.t;
          const cv::Point2d corner(600 * at[0] / at[2] + 399.5, 600 * at[1] / at[2] + 299.5);
          EXPECT_LT(cv::norm(found[0].corners[k] - corner), side < 30 ? 0.5 : 0.2)
              << side << " px, frame " << has_frame << ", id " << id << ", corner " << k;
        }
      }
    }
}

TEST(Aruco, CornersAreRightWhereEdgesAreManyPixelsWide) {
  for (const double times : {2.0, 4.0})
    for (const double side : {40.0, 80.0, 150.0})
      for (int i = 0; i < 3; ++i) {
        const auto truth =
            truth_at(0.0007 * i, 0.0011 * i, 600 * kSide / side, 0.1, -0.2, 0.5 - 0.4 * i);
        cv::Mat image = view(framed(17 * i + 3, i == 1), truth, kCamera, 2);
        cv::resize(image, image, {}, times, times, cv::INTER_CUBIC);
        const auto found = find(MarkerKind::Aruco, image);
        ASSERT_EQ(found.size(), 1) << side << " px, times " << times;
        for (std::size_t k = 0; k < 4; ++k) {
          const double right = k == 1 || k == 2 ? 0.5 : -0.5, down = k >= 2 ? 0.5 : -0.5;
          const cv::Vec3d at = truth.R * cv::Vec3d(kSide * right, kSide * down, 0) + truth.t;
          const cv::Point2d corner(600 * at[0] / at[2] + 400, 600 * at[1] / at[2] + 300);
          const cv::Point2d seen = (found[0].corners[k] + cv::Point2d(0.5, 0.5)) / times;
          EXPECT_LT(cv::norm(seen - corner), 0.2)
              << side << " px, times " << times << ", id " << found[0].id << ", corner " << k;
        }
      }
}

TEST(Finders, ImagesWithoutMarkersAndUnknownDictionaries) {
  cv::Mat noise(480, 640, CV_8U);
  cv::RNG(3).fill(noise, cv::RNG::UNIFORM, 0, 256);
  auto aruco = must(ArucoFinder::make("6X6_250"));
  EXPECT_TRUE(aruco.find(noise).empty());
  AprilTagFinder apriltag(1);
  EXPECT_TRUE(apriltag.find(noise).empty());
  EXPECT_TRUE(apriltag.find(cv::Mat(4, 4, CV_8U, cv::Scalar(0))).empty());
  EXPECT_EQ(ArucoFinder::make("9X9_1").error().code, Code::Invalid);
}

/// Corners of a marker that is tilted by an angle, straight ahead.
Marker tilted(double distance, double tilt) {
  const double half = kSide / 2;
  const std::vector<cv::Point3d> square = {
      {-half, half, 0}, {half, half, 0}, {half, -half, 0}, {-half, -half, 0}};
  const auto& p = kCamera.pinhole;
  std::vector<cv::Point2d> seen;
  cv::projectPoints(square, cv::Vec3d(CV_PI - tilt, 0, 0), cv::Vec3d(0, 0, distance),
                    cv::Matx33d(p.fx, 0, p.cx, 0, p.fy, p.cy, 0, 0, 1), cv::noArray(), seen);
  Marker marker;
  std::copy(seen.begin(), seen.end(), marker.corners.begin());
  return marker;
}

TEST(Marker, TwoRotationsThatFitAreSaid) {
  constexpr double kTilt = 25 * CV_PI / 180;
  const auto far = pose_of(tilted(8, kTilt), kSide, kCamera);
  ASSERT_TRUE(far);
  EXPECT_NEAR(far->ambiguity, 2 * kTilt, 0.1);
  EXPECT_NEAR(far->t[2], 8, 0.02);
  for (const auto& [distance, tilt] : {std::pair{0.5, kTilt}, {0.5, 0.7}, {1.0, 0.9}, {0.5, 0.0}}) {
    const auto sure = pose_of(tilted(distance, tilt), kSide, kCamera);
    ASSERT_TRUE(sure);
    EXPECT_EQ(sure->ambiguity, 0) << distance << " " << tilt;
  }
}

}  // namespace
}  // namespace hc::vision
