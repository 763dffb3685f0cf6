// SPDX-License-Identifier: Apache-2.0
#include <vision/calibration.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>
#include <regex>
#include <string>

#include <Eigen/Geometry>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include <hc/testing/files.h>
#include <hc/testing/must.h>

namespace hc::vision {
namespace {

constexpr Board kBoard{9, 6, 1.0};

struct Pairs {
  std::vector<BoardView> views;
  cv::Size size;
};

/// Corners found as in OpenCV's sample stereo_calib.
BoardView view_of_sample(const cv::Mat& left, const cv::Mat& right) {
  BoardView view;
  for (auto [image, corners] : {std::pair{&left, &view.left}, {&right, &view.right}}) {
    const bool is_found = cv::findChessboardCorners(
        *image, {9, 6}, *corners, cv::CALIB_CB_ADAPTIVE_THRESH | cv::CALIB_CB_NORMALIZE_IMAGE);
    EXPECT_TRUE(is_found);
    cv::cornerSubPix(*image, *corners, {11, 11}, {-1, -1},
                     {cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 30, 0.01});
  }
  return view;
}

/// The images of opencv-doc, in which OpenCV's own sample finds 13 pairs.
Pairs photographs(bool as_sample) {
  const char* folder = std::getenv("HC_DATA");
  const std::string data = folder ? folder : "/usr/share/doc/opencv-doc/examples/data";
  Pairs pairs;
  for (int number = 1; number <= 14; ++number) {
    if (number == 10) continue;
    char name[32];
    std::snprintf(name, sizeof name, "%02d.jpg", number);
    cv::Mat left = cv::imread(data + "/left" + name, cv::IMREAD_GRAYSCALE);
    cv::Mat right = cv::imread(data + "/right" + name, cv::IMREAD_GRAYSCALE);
    if (left.empty() || right.empty()) continue;
    pairs.size = left.size();
    if (as_sample)
      pairs.views.push_back(view_of_sample(left, right));
    else if (auto view = find_board(left, right, kBoard))
      pairs.views.push_back(*view);
  }
  return pairs;
}

/// Views of a board by two known cameras, with noise [px].
Pairs made_up(const StereoCalibration& truth, int count, double noise) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> spread(-1, 1);
  std::normal_distribution<float> error(0, static_cast<float>(noise));
  std::vector<cv::Point3f> board;
  for (int row = 0; row < 6; ++row)
    for (int column = 0; column < 9; ++column)
      board.emplace_back(static_cast<float>(0.04 * (column - 4)),
                         static_cast<float>(0.04 * (row - 2.5)), 0.0F);
  Pairs pairs{{}, truth.size};
  for (int i = 0; i < count; ++i) {
    cv::Vec3d turn(0.4 * spread(random), 0.4 * spread(random), 0.3 * spread(random));
    cv::Vec3d shift(0.1 * spread(random), 0.08 * spread(random), 0.6 + 0.15 * spread(random));
    cv::Matx33d turned;
    cv::Rodrigues(turn, turned);
    cv::Vec3d right_turn, right_shift = truth.R * shift + truth.T;
    cv::Rodrigues(truth.R * turned, right_turn);
    BoardView view;
    cv::projectPoints(board, turn, shift, truth.M1, truth.D1, view.left);
    cv::projectPoints(board, right_turn, right_shift, truth.M2, truth.D2, view.right);
    for (auto* corners : {&view.left, &view.right})
      for (auto& corner : *corners) corner += cv::Point2f(error(random), error(random));
    pairs.views.push_back(view);
  }
  return pairs;
}

StereoCalibration squinting() {
  StereoCalibration truth = ideal_pair({800, 600}, 600, 0.1);
  truth.M2(0, 0) = truth.M2(1, 1) = 610;
  truth.M2(0, 2) += 8;
  truth.D1 = {-0.2, 0.05, 0.001, -0.0005, 0};
  truth.D2 = {-0.18, 0.04, 0, 0.0005, 0};
  cv::Rodrigues(cv::Vec3d(0.01, 0.05, -0.02), truth.R);
  truth.T = {-0.1, 0.002, 0.004};
  rectify(truth);
  return truth;
}

TEST(Calibration, FindsCamerasThatAreKnown) {
  const auto truth = squinting();
  auto pairs = made_up(truth, 20, 0.1);
  auto found = must(calibrate(pairs.views, {9, 6, 0.04}, pairs.size));
  const auto& c = found.calibration;
  EXPECT_NEAR(c.rms, 0.1 * std::sqrt(2), 0.02) << "px: the noise in x and y";
  EXPECT_EQ(found.views, 20);
  EXPECT_NEAR(c.M1(0, 0), 600, 3);
  EXPECT_NEAR(c.M2(0, 0), 610, 3);
  EXPECT_LT(cv::norm(c.T - truth.T), 1e-3) << "m";
  EXPECT_NEAR(c.baseline(), cv::norm(truth.T), 1e-3) << "m";
  cv::Vec3d off;
  cv::Rodrigues(c.R * truth.R.t(), off);
  EXPECT_LT(cv::norm(off), 2e-3) << "rad";
  EXPECT_LT(found.epipolar, 0.2) << "px";
}

TEST(Calibration, LeavesOutAViewThatIsWrong) {
  auto pairs = made_up(squinting(), 15, 0.1);
  for (auto& corner : pairs.views[4].right) corner.y += 9;
  auto found = must(calibrate(pairs.views, {9, 6, 0.04}, pairs.size));
  EXPECT_EQ(found.views, 14);
  EXPECT_EQ(found.numbers()[5], 14);
  EXPECT_TRUE(found.text().ends_with(" m, 14 of 15 views")) << found.text();
  EXPECT_LT(found.calibration.rms, 0.2) << "px";
}

TEST(Calibration, CamerasThatAreMixedUpAreReported) {
  auto pairs = made_up(squinting(), 6, 0.1);
  for (auto& view : pairs.views) std::swap(view.left, view.right);
  EXPECT_NE(refused(calibrate(pairs.views, {9, 6, 0.04}, pairs.size))
                .detail.find("the left camera is on the right"),
            std::string::npos);
}

TEST(Calibration, RefusesWhatDoesNotDetermineTheCameras) {
  auto pairs = made_up(squinting(), 2, 0.1);
  const auto found = refused(calibrate(pairs.views, {9, 6, 0.04}, pairs.size));
  EXPECT_EQ(found.code, Code::NotFound);
  EXPECT_NE(found.detail.find("2 views"), std::string::npos);
  pairs = made_up(squinting(), 4, 0.1);
  EXPECT_EQ(calibrate(pairs.views, {6, 6, 0.04}, pairs.size).error().code, Code::Invalid);
  for (auto& view : pairs.views) {
    std::fill(view.left.begin(), view.left.end(), cv::Point2f(5, 5));
    view.right = view.left;
  }
  EXPECT_FALSE(calibrate(pairs.views, {9, 6, 0.04}, pairs.size));
}

TEST(Calibration, TheSameCornerHasTheSamePlaceInBothImages) {
  cv::Mat image(480, 640, CV_8U, cv::Scalar(255));
  for (int row = 0; row < 7; ++row)
    for (int column = 0; column < 10; ++column)
      if ((row + column) % 2 == 0)
        cv::rectangle(image, cv::Rect(60 + 50 * column, 60 + 50 * row, 50, 50), 0, cv::FILLED);
  auto view = must(find_board(image, image, kBoard));
  EXPECT_LT(cv::norm(view.left[3] - view.right[3]), 1e-3);
  EXPECT_NEAR(cv::norm(view.left.front() - view.left.back()), std::hypot(400, 250), 0.1);
  BoardView moved = view;
  for (auto& corner : moved.left) corner.x += 10;
  EXPECT_NEAR(difference(view, moved), 5, 1e-3) << "px: the mean of both eyes";
  EXPECT_FALSE(find_board(cv::Mat::zeros(480, 640, CV_8U), image, kBoard));
  EXPECT_FALSE(find_board(cv::Mat(), cv::Mat(), kBoard));
}

// OpenCV's sample stereo_calib with its own flags.
double rms_of_sample(const Pairs& pairs) {
  std::vector<std::vector<cv::Point3f>> object(pairs.views.size());
  std::vector<std::vector<cv::Point2f>> left, right;
  for (std::size_t i = 0; i < object.size(); ++i) {
    for (int row = 0; row < 6; ++row)
      for (int column = 0; column < 9; ++column)
        object[i].emplace_back(static_cast<float>(column), static_cast<float>(row), 0.0F);
    left.push_back(pairs.views[i].left);
    right.push_back(pairs.views[i].right);
  }
  cv::Mat M1 = cv::initCameraMatrix2D(object, left, pairs.size, 0), D1, R, T, E, F;
  cv::Mat M2 = cv::initCameraMatrix2D(object, right, pairs.size, 0), D2;
  return cv::stereoCalibrate(object, left, right, M1, D1, M2, D2, pairs.size, R, T, E, F,
                             cv::CALIB_FIX_ASPECT_RATIO | cv::CALIB_ZERO_TANGENT_DIST |
                                 cv::CALIB_USE_INTRINSIC_GUESS | cv::CALIB_SAME_FOCAL_LENGTH |
                                 cv::CALIB_RATIONAL_MODEL | cv::CALIB_FIX_K3 | cv::CALIB_FIX_K4 |
                                 cv::CALIB_FIX_K5,
                             {cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 100, 1e-5});
}

TEST(Calibration, PhotographsAreNoWorseThanWithOpenCvsSample) {
  const auto pairs = photographs(false);
  ASSERT_EQ(pairs.views.size(), 13);
  const double reference = rms_of_sample(photographs(true));
  auto found = must(calibrate(pairs.views, kBoard, pairs.size));
  EXPECT_LE(found.rms_all, reference) << "px, of the same views";
  EXPECT_LE(found.calibration.rms, found.rms_all);
  std::printf(
      "[          ] rms %.3f px of all, %.3f px of %zu views (left %.3f, right %.3f), rows %.3f "
      "px; "
      "OpenCV's sample %.3f px\n",
      found.rms_all, found.calibration.rms, found.views, found.rms_left, found.rms_right,
      found.epipolar, reference);
  EXPECT_NEAR(found.calibration.M1(0, 0), 534, 8) << "px, as intrinsics.yml of opencv-doc";
  EXPECT_NEAR(found.calibration.baseline(), 3.34, 0.05) << "squares";
}

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
  truth.head = {0, 0.01, -0.02, 0, 0, 0, 0.3};
  auto read = must(calibration_of(text_of(truth)));
  EXPECT_EQ(read.size, truth.size);
  EXPECT_EQ(read.D1, truth.D1);
  EXPECT_EQ(read.P2, truth.P2);
  EXPECT_EQ(read.T, truth.T);
  EXPECT_EQ(read.Q, truth.Q);
  EXPECT_EQ(read.rms, 0.25);
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
