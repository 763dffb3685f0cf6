// SPDX-License-Identifier: Apache-2.0
#include <vision/stereo_fit.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <string>

#include <opencv2/calib3d.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include <hc/testing/must.h>
#include <vision/board_pose_test.h>
#include <vision/squinting_pair_test.h>

namespace hc::vision {
namespace {

constexpr Board kHeld{9, 6, 0.04}, kOfPhotographs{9, 6, 1.0};

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
    else if (auto view = find_board(left, right, kOfPhotographs))
      pairs.views.push_back(*view);
  }
  return pairs;
}

/// How somebody holds a board in front of two cameras.
struct Hand {
  double up_down = 0.5, left_right = 0.5;  ///< most it is tilted about each axis [rad]
  double nearest = 0.5, farthest = 0.9;    ///< [m]
  double sideways = 0.25;                  ///< most its centre is beside the axis, of its distance
};

/// Views of a board by two known cameras, complete in both, with noise [px].
Pairs made_up(const StereoCalibration& truth, int count, double noise, const Hand& hand = {},
              unsigned seed = 3) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> spread(-1, 1);
  std::normal_distribution<float> error(0, static_cast<float>(noise));
  const cv::Rect2f image(cv::Point2f(), truth.size);
  Pairs pairs{{}, truth.size};
  while (static_cast<int>(pairs.views.size()) < count) {
    const cv::Vec3d tilt(hand.up_down * spread(random), hand.left_right * spread(random), 0);
    const double z =
        (hand.nearest + hand.farthest) / 2 + (hand.farthest - hand.nearest) / 2 * spread(random);
    const double beside = hand.sideways * z;
    auto pose = BoardPose::at(kHeld, tilt,
                              {beside * spread(random) + 0.05, 0.8 * beside * spread(random), z});
    cv::Matx33d roll;
    cv::Rodrigues(cv::Vec3d(0, 0, 0.3 * spread(random)), roll);
    pose.R = pose.R * roll;
    BoardView view = view_of(kHeld, pose, truth);
    bool is_complete = true;
    for (auto* seen : {&view.left, &view.right})
      for (auto& corner : *seen) {
        is_complete = is_complete && image.contains(corner);
        corner += cv::Point2f(error(random), error(random));
      }
    if (is_complete) pairs.views.push_back(view);
  }
  return pairs;
}

TEST(Calibration, FindsCamerasThatAreKnown) {
  const auto truth = squinting();
  auto pairs = made_up(truth, 20, 0.1);
  auto found = must(calibrate(pairs.views, kHeld, pairs.size));
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

TEST(Calibration, EachViewMayShowAnotherPartOfTheBoard) {
  const auto truth = squinting();
  auto pairs = made_up(truth, 40, 0.1);
  std::mt19937 random(7);
  for (auto& view : pairs.views) {
    BoardView part;
    const auto first = random() % 27;
    for (std::size_t i = first; i < first + 27; ++i) {
      part.numbers.push_back(i);
      part.left.push_back(view.left[i]);
      part.right.push_back(view.right[i]);
    }
    view = part;
  }
  const auto found = must(calibrate(pairs.views, kHeld, pairs.size));
  EXPECT_NEAR(found.calibration.rms, 0.1 * std::sqrt(2), 0.02) << "px: the noise in x and y";
  EXPECT_NEAR(found.calibration.M1(0, 0), 600, 5);
  EXPECT_LT(cv::norm(found.calibration.T - truth.T), 1e-3) << "m";
  EXPECT_NEAR(error_of(truth, pairs.views, kHeld), 0.1 * std::sqrt(2), 0.03) << "px";
}

TEST(Calibration, LeavesOutAViewThatIsWrong) {
  auto pairs = made_up(squinting(), 15, 0.1);
  for (auto& corner : pairs.views[4].right) corner.y += 9;
  auto found = must(calibrate(pairs.views, kHeld, pairs.size));
  EXPECT_EQ(found.views, 14);
  EXPECT_EQ(found.numbers()[5], 14);
  EXPECT_TRUE(found.text().ends_with(", 14 of 15 views")) << found.text();
  EXPECT_LT(found.calibration.rms, 0.2) << "px";
}

TEST(Calibration, CamerasThatAreMixedUpAreReported) {
  auto pairs = made_up(squinting(), 20, 0.1);
  for (auto& view : pairs.views) std::swap(view.left, view.right);
  EXPECT_NE(refused(calibrate(pairs.views, kHeld, pairs.size))
                .detail.find("the left camera is on the right"),
            std::string::npos);
}

TEST(Calibration, RefusesWhatDoesNotDetermineTheCameras) {
  auto pairs = made_up(squinting(), 2, 0.1);
  const auto found = refused(calibrate(pairs.views, kHeld, pairs.size));
  EXPECT_EQ(found.code, Code::NotFound);
  EXPECT_NE(found.detail.find("2 views"), std::string::npos);
  pairs = made_up(squinting(), 4, 0.1);
  EXPECT_EQ(calibrate(pairs.views, {6, 6, 0.04}, pairs.size).error().code, Code::Invalid);
  for (auto& view : pairs.views) {
    std::fill(view.left.begin(), view.left.end(), cv::Point2f(5, 5));
    view.right = view.left;
  }
  EXPECT_FALSE(calibrate(pairs.views, kHeld, pairs.size));
}

/// @param wanted  a part of the error text.
void expect_undetermined(const StereoCalibration& truth, const Hand& hand,
                         const std::string& wanted, int count = 15) {
  const auto pairs = made_up(truth, count, 0.1, hand);
  const auto found = calibrate(pairs.views, kHeld, pairs.size);
  ASSERT_FALSE(found) << found->text();
  EXPECT_EQ(found.error().code, Code::NotFound);
  EXPECT_NE(found.error().detail.find(wanted), std::string::npos) << found.error().detail;
}

TEST(Calibration, ABoardThatFacesTheCamerasDoesNotDetermineTheFocalLength) {
  const Hand facing{.up_down = 0.02, .left_right = 0.02};
  expect_undetermined(squinting(), facing, "do not determine the focal length: ± ");
  const Hand at_one_distance{.up_down = 0.02, .left_right = 0.02, .nearest = 0.7, .farthest = 0.7};
  expect_undetermined(squinting(), at_one_distance, "do not determine the focal length: ± ");
}

TEST(Calibration, ABoardInTheMiddleDoesNotDetermineTheEdges) {
  expect_undetermined(squinting(), {.nearest = 1.1, .farthest = 1.5, .sideways = 0.02},
                      "do not determine");
}

// The deviations are those of repeated calibrations.
TEST(Calibration, DeviationsAreWhatTheyClaim) {
  const auto truth = squinting();
  double focal = 0, baseline = 0, said_focal = 0, said_baseline = 0;
  constexpr int kSets = 8;
  for (unsigned seed = 0; seed < kSets; ++seed) {
    const auto pairs = made_up(truth, 20, 0.1, {}, seed);
    const auto found = must(calibrate(pairs.views, kHeld, pairs.size));
    const auto& c = found.calibration;
    focal +=
        std::pow(c.M1(0, 0) / truth.M1(0, 0) - 1, 2) + std::pow(c.M2(0, 0) / truth.M2(0, 0) - 1, 2);
    baseline += 2 * std::pow(cv::norm(c.T) / cv::norm(truth.T) - 1, 2);
    said_focal += 2 * std::pow(found.deviations.focal, 2);
    said_baseline += 2 * std::pow(found.deviations.baseline, 2);
  }
  std::printf(
      "[          ] focal length off by %.3f %%, said %.3f %%; baseline %.3f %%, said %.3f %%\n",
      100 * std::sqrt(focal / 2 / kSets), 100 * std::sqrt(said_focal / 2 / kSets),
      100 * std::sqrt(baseline / 2 / kSets), 100 * std::sqrt(said_baseline / 2 / kSets));
  EXPECT_NEAR(std::log2(std::sqrt(focal / said_focal)), 0, 1) << "within a factor of two";
  EXPECT_NEAR(std::log2(std::sqrt(baseline / said_baseline)), 0, 1);
}

TEST(Calibration, ACalibrationThatFitsTheViewsIsKnownByItsError) {
  const auto pairs = made_up(squinting(), 6, 0.1);
  EXPECT_NEAR(error_of(squinting(), pairs.views, kHeld), 0.1 * std::sqrt(2), 0.03) << "px";
  auto moved = squinting();
  moved.T[1] += 0.003;
  EXPECT_GT(error_of(moved, pairs.views, kHeld), 1) << "px: 3 mm at 0.7 m are 2.6 px";
}

/// A set of views that some cameras have, good or not.
struct Set {
  StereoCalibration truth;
  Hand hand;
  int count;
  double noise;  // [px]
  bool is_good;
};

Set set_of(unsigned number) {
  std::mt19937 random(100 + number);
  std::uniform_real_distribution<double> part(0, 1);
  const auto between = [&](double least, double most) {
    return least + (most - least) * part(random);
  };
  Set set{squinting(), {}, static_cast<int>(between(15, 25)), between(0.05, 0.3), number % 2 == 0};
  const double focal = between(450, 900);
  for (auto* M : {&set.truth.M1, &set.truth.M2})
    (*M)(0, 0) = (*M)(1, 1) = focal * between(0.98, 1.02);
  set.truth.T *= between(0.6, 1.2);
  const double near = focal / 800 * 0.55;  // the board fills the image's height
  set.hand = {.nearest = near, .farthest = 1.8 * near, .sideways = 0.2 * 800 / focal};
  if (set.is_good) return set;
  Hand& hand = set.hand;
  switch (number / 2 % 6) {
    case 0:  // faces the cameras
      hand.up_down = hand.left_right = between(0, 0.08);
      break;
    case 1:  // and always at one distance
      hand.up_down = hand.left_right = between(0, 0.08);
      hand.farthest = hand.nearest *= 1.3;
      break;
    case 2:  // tilted about one axis, a little
      hand.up_down = 0;
      hand.left_right = between(0, 0.2);
      break;
    case 3:  // few views
      set.count = static_cast<int>(between(3, 6));
      break;
    case 4:  // far away
      hand.nearest *= 4;
      hand.farthest = 1.2 * hand.nearest;
      hand.sideways = 0.05;
      break;
    default:  // hardly moves
      hand = {.up_down = 0.05,
              .left_right = 0.05,
              .nearest = 1.3 * near,
              .farthest = 1.35 * near,
              .sideways = 0.03};
  }
  return set;
}

TEST(Calibration, OfFiftySetsNoWrongFocalLengthIsAccepted) {
  int wrong = 0, refused = 0, accepted = 0, unsafe = 0;
  double worst = 0;
  for (unsigned number = 0; number < 50; ++number) {
    const Set set = set_of(number);
    const auto pairs = made_up(set.truth, set.count, set.noise, set.hand, number);
    const auto found = calibrate(pairs.views, kHeld, pairs.size);
    if (!found) {
      refused += set.is_good;
      if (set.is_good)
        std::printf("[          ] good set %u of %d views, %.2f px: %s\n", number, set.count,
                    set.noise, found.error().detail.c_str());
      continue;
    }
    accepted += set.is_good;
    unsafe += !set.is_good;
    const auto& c = found->calibration;
    const double off = std::max({std::abs(c.M1(0, 0) / set.truth.M1(0, 0) - 1),
                                 std::abs(c.M2(0, 0) / set.truth.M2(0, 0) - 1),
                                 std::abs(c.M1(1, 1) / set.truth.M1(1, 1) - 1),
                                 std::abs(c.M2(1, 1) / set.truth.M2(1, 1) - 1)});
    worst = std::max(worst, off);
    wrong += off > 0.02;
  }
  std::printf(
      "[          ] %d good sets accepted, %d refused; %d others accepted; focal length off by at "
      "most %.2f %%\n",
      accepted, refused, unsafe, 100 * worst);
  EXPECT_EQ(wrong, 0);
  EXPECT_LE(refused, 2);
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
  auto found = must(calibrate(pairs.views, kOfPhotographs, pairs.size));
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

}  // namespace
}  // namespace hc::vision
