// SPDX-License-Identifier: Apache-2.0
#include <vision/calibration.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>
#include <regex>
#include <string>

#include <Eigen/Geometry>
#include <opencv2/calib3d.hpp>

#include <hc/testing/files.h>
#include <hc/testing/must.h>
#include <vision/squinting_pair_test.h>

namespace hc::vision {
namespace {

TEST(StereoCalibration, TheRightCameraTurnsAboutItsOwnMiddle) {
  auto c = squinting();
  const cv::Vec3d middle = -(c.R.t() * c.T);
  const auto as_it_is = c;
  turn(c, c.R_left_right());
  EXPECT_EQ(c.R1, as_it_is.R1);
  const Eigen::Matrix3d R =
      Eigen::AngleAxisd(0.03, Eigen::Vector3d(1, 2, -1).normalized()).matrix();
  turn(c, R);
  EXPECT_NEAR((c.R_left_right() - R).norm(), 0, 1e-12);
  EXPECT_NEAR(cv::norm(-(c.R.t() * c.T) - middle), 0, 1e-12);
  // Forward of the right camera in the left camera's frame.
  const cv::Vec3d forward = c.R.t() * cv::Vec3d(0, 0, 1);
  EXPECT_NEAR((Eigen::Vector3d(forward[0], forward[1], forward[2]) - R.col(2)).norm(), 0, 1e-12);
  EXPECT_NE(c.R1, as_it_is.R1);
  EXPECT_NEAR(c.baseline(), as_it_is.baseline(), 1e-9);
}

TEST(StereoCalibration, ARayIsWhatTheLensBends) {
  const auto c = squinting();
  for (Eye eye : {Eye::Left, Eye::Right}) {
    const bool is_left = eye == Eye::Left;
    std::vector<cv::Point2d> seen;
    cv::projectPoints(std::vector<cv::Point3d>{{0.3, -0.2, 1}}, cv::Vec3d(), cv::Vec3d(),
                      is_left ? c.M1 : c.M2, is_left ? c.D1 : c.D2, seen);
    const cv::Vec2d ray = ray_of(c, eye, seen[0]);
    EXPECT_NEAR(ray[0], 0.3, 1e-4);
    EXPECT_NEAR(ray[1], -0.2, 1e-4);
  }
}

TEST(CalibrationFile, ComesBackAsItWas) {
  auto truth = squinting();
  truth.rms = 0.25;
  truth.focal_deviation = 0.001;
  truth.head = {0, 0.01, -0.02, 0, 0, 0, 0.3};
  auto read = must(calibration_of(text_of(truth)));
  EXPECT_EQ(read.size, truth.size);
  EXPECT_EQ(read.D1, truth.D1);
  EXPECT_EQ(read.P2, truth.P2);
  EXPECT_EQ(read.T, truth.T);
  EXPECT_EQ(read.Q, truth.Q);
  EXPECT_EQ(read.rms, 0.25);
  EXPECT_EQ(read.focal_deviation, 0.001);
  EXPECT_EQ(read.head, truth.head);
  const Folder folder;
  const auto path = folder / "calibration.yml";
  ASSERT_TRUE(write_calibration(path, truth));
  EXPECT_EQ(read_calibration(path)->R1, truth.R1);
  std::filesystem::remove(path);
  EXPECT_EQ(read_calibration(path).error().code, Code::System);
  EXPECT_EQ(read_calibration("/").error().code, Code::System);
  EXPECT_EQ(write_calibration("/no/such/folder/c.yml", truth).error().code, Code::NotFound);
}

TEST(CalibrationFile, IsKnownToBeOfAnotherProgram) {
  const Folder folder;
  const auto path = folder / "calibration.yml";
  const auto first = squinting();
  auto other = first;
  other.T[0] *= 1.01;
  EXPECT_FALSE(has_changed(path, std::nullopt)) << "there is none";
  EXPECT_FALSE(has_changed(path, first)) << "removed, so nothing is lost";
  ASSERT_TRUE(write_calibration(path, first));
  EXPECT_TRUE(has_changed(path, std::nullopt));
  const auto read = must(read_calibration(path));
  EXPECT_FALSE(has_changed(path, read));
  ASSERT_TRUE(write_calibration(path, other));
  EXPECT_TRUE(has_changed(path, read));
  std::ofstream(path) << "not a calibration";
  EXPECT_TRUE(has_changed(path, read));
  EXPECT_FALSE(has_changed("/dev/null", std::nullopt));
}

// In the format of OpenCV's sample: two files, without size and rms, T in squares.
TEST(CalibrationFile, OpenCvsOwnFilesAreRead) {
  const auto truth = squinting();
  cv::FileStorage intrinsics("i.yml", cv::FileStorage::WRITE | cv::FileStorage::MEMORY);
  intrinsics << "M1" << cv::Mat(truth.M1) << "D1" << cv::Mat(truth.D1).reshape(1, 1) << "M2"
             << cv::Mat(truth.M2) << "D2" << cv::Mat(truth.D2).reshape(1, 1);
  cv::FileStorage extrinsics("e.yml", cv::FileStorage::WRITE | cv::FileStorage::MEMORY);
  extrinsics << "R" << cv::Mat(truth.R) << "T" << cv::Mat(truth.T) << "R1" << cv::Mat(truth.R1)
             << "R2" << cv::Mat(truth.R2) << "P1" << cv::Mat(truth.P1) << "P2" << cv::Mat(truth.P2)
             << "Q" << cv::Mat(truth.Q);
  const std::string first = intrinsics.releaseAndGetString();
  auto read = must(calibration_of(first + extrinsics.releaseAndGetString()));
  EXPECT_EQ(read.size, cv::Size());
  EXPECT_EQ(read.M2, truth.M2);
  const auto half = refused(calibration_of(first));
  EXPECT_NE(half.detail.find("R is missing"), std::string::npos) << half.detail;
}

TEST(CalibrationFile, WhatIsHostileIsRefused) {
  const std::string good = text_of(squinting());
  ASSERT_TRUE(calibration_of(good));
  auto changed = [&](const std::string& pattern, const std::string& with) {
    std::string text = std::regex_replace(good, std::regex(pattern), with,
                                          std::regex_constants::format_first_only);
    EXPECT_NE(text, good) << pattern;
    return text;
  };
  struct Case {
    std::string text, says;
  };
  const Case cases[] = {
      {"", "does not begin"},
      {"<?xml version=\"1.0\"?><opencv_storage/>", "does not begin"},
      {"%YAML:1.0\n---\n", "calibration:"},
      {"%YAML:1.0\n---\nM1: [", "calibration:"},
      {"%YAML:1.0\n---\nM1: " + std::string(30000, '['), "too many lists"},
      {"%YAML:1.0\n---\nM1: " + std::string(30000, '{'), "too many lists"},
      {[] {
         std::string dashes = "%YAML:1.0\n---\nM1:\n   ";
         for (int i = 0; i < 20000; ++i) dashes += "- ";
         return dashes;
       }(),
       "too many lists"},
      {good + std::string(70000, ' '), "more than 65536 bytes"},
      {good.substr(0, good.size() / 2), "calibration:"},
      {good + std::string(1, '\0'), "zero byte"},
      {changed("M1:", "N1:"), "M1 is missing"},
      {changed("Q:", "q:"), "Q is missing"},
      {changed("rows: 3", "rows: 2"), "M1 does not have the stated shape"},
      {changed("rows: 3", "rows: 1000000000"), "M1 does not have the stated shape"},
      {changed("rows: 3", "rows: -3"), "M1 does not have the stated shape"},
      {changed("dt: d", "dt: u"), "M1 has elements"},
      {changed("dt: d", "dt: \"2000000000d\""), "M1 has elements"},
      {changed("M1: !!opencv-matrix[^\\]]*\\]", "M1: 5"), "M1 is not a matrix"},
      {changed("data: \\[ [^,]*,", "data: [ .Nan,"), "M1 contains a value that is not finite"},
      {changed("data: \\[ [^,]*,", "data: [ .Inf,"), "M1 contains a value that is not finite"},
      {changed("data: \\[ [^,]*,", "data: [ word,"), "M1 contains a value that is not a number"},
      {changed("data: \\[ [^,]*,", "data: [ -5.,"), "M1 is not a camera"},
      {changed("data: \\[ [^,]*,", "data: [ 1e30,"), "M1 is not a camera"},
      {changed("image_width: 800", "image_width: 800000000"), "from 1 to 65535"},
      {changed("image_width: 800", "image_width: -1"), "from 1 to 65535"},
      {changed("image_width: 800", "image_width: wide"), "not an integer"},
      {changed("image_width: 800\n", ""), "image_width or image_height is missing"},
      {changed("R: !!opencv-matrix([^\\[]*)\\[ [^,]*,", "R: !!opencv-matrix$1[ 0.5,"),
       "R is not a rotation"},
      {changed("T: !!opencv-matrix([^\\[]*)\\[ [^,]*,", "T: !!opencv-matrix$1[ 1e9,"),
       "T is not a valid baseline"},
      {changed("D1: !!opencv-matrix([^\\[]*)cols: 5([^\\[]*)\\[ [^,]*,",
               "D1: !!opencv-matrix$1cols: 4$2["),
       ""},
  };
  for (const auto& each : cases) {
    auto read = calibration_of(each.text);
    if (each.says.empty()) {
      EXPECT_TRUE(read) << "four distortion coefficients are valid";
      continue;
    }
    ASSERT_FALSE(read) << each.says;
    EXPECT_NE(read.error().detail.find(each.says), std::string::npos)
        << read.error().detail << ", not " << each.says;
  }
  auto swapped = squinting();
  swapped.P2(0, 3) = -swapped.P2(0, 3);
  EXPECT_NE(calibration_of(text_of(swapped)).error().detail.find("is on the right"),
            std::string::npos);
}

TEST(CalibrationFile, DamageNeverGoesUnnoticedOrFurther) {
  const std::string good = text_of(squinting());
  std::mt19937 random(11);
  int refused = 0;
  for (int i = 0; i < 3000; ++i) {
    std::string text = good;
    for (int change = 0; change < 1 + i % 4; ++change) {
      const auto at = random() % text.size();
      if (random() % 3 == 0)
        text.erase(at, random() % 20);
      else
        text[at] = static_cast<char>(random() % 128);
      if (text.empty()) text = " ";
    }
    auto read = calibration_of(text);
    if (!read)
      ++refused;
    else
      EXPECT_GT(read->baseline(), 0);
  }
  EXPECT_GT(refused, 100);
}

}  // namespace
}  // namespace hc::vision
