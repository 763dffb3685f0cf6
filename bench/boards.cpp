// SPDX-License-Identifier: Apache-2.0
// boards: the search of boards, their corners and the calibration from drawn views, beside OpenCV's
// findChessboardCorners, cornerSubPix, interpolateCornersCharuco and the flags of its sample
// stereo_calib, as Markdown.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <map>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <vision/board.h>
#include <vision/drawn_board_test.h>
#include <vision/marked_board.h>
#include <vision/opencv_charuco_test.h>
#include <vision/squinting_pair_test.h>
#include <vision/stereo_fit.h>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "measure.h"

namespace {

using hc::vision::Board, hc::vision::BoardPose, hc::vision::BoardView, hc::vision::DrawingCamera;
using hc::vision::StereoCalibration;
using Corners = std::vector<cv::Point2f>;

constexpr Board kBoard{9, 6, 0.025};

cv::Size size_of(const Board& board) {
  return {board.columns, board.rows};
}

bool find_as_sample(const cv::Mat& image, const Board& board, Corners& corners) {
  return cv::findChessboardCorners(image, size_of(board), corners,
                                   cv::CALIB_CB_ADAPTIVE_THRESH | cv::CALIB_CB_NORMALIZE_IMAGE);
}

void refine_as_sample(const cv::Mat& image, Corners& corners) {
  cv::cornerSubPix(image, corners, {11, 11}, {-1, -1},
                   {cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 30, 0.01});
}

void time_search(const char* name, const cv::Mat& image, const Board& board) {
  bool is_found = false, is_found_by_sample = false;
  Corners corners;
  const double ours = bench::milliseconds(
      [&] { is_found = hc::vision::find_board(image, image, board).has_value(); });
  const double sample =
      2 * bench::milliseconds([&] { is_found_by_sample = find_as_sample(image, board, corners); });
  std::printf("| %s | %d × %d | %d × %d | %.0f%s | %.0f%s |\n", name, image.cols, image.rows,
              board.columns, board.rows, ours, is_found ? "" : ", not found", sample,
              is_found_by_sample ? "" : ", not found");
  std::fflush(stdout);
}

cv::Mat photograph(const char* name) {
  const char* folder = std::getenv("HC_DATA");
  return cv::imread(
      std::string(folder == nullptr ? "/usr/share/doc/opencv-doc/examples/data" : folder) + "/" +
          name,
      cv::IMREAD_GRAYSCALE);
}

/// Root mean square and largest distance of corners from the truth [px].
struct Off {
  double squares = 0, worst = 0;
  int count = 0;

  void add(Corners corners, const Corners& truth) {
    if ((corners.back() - corners.front()).dot(truth.back() - truth.front()) < 0)
      std::reverse(corners.begin(), corners.end());
    for (std::size_t i = 0; i < truth.size(); ++i) add(corners[i], truth[i]);
  }
  void add(cv::Point2f corner, cv::Point2f truth) {
    const double off = cv::norm(corner - truth);
    squares += off * off;
    worst = std::max(worst, off);
    ++count;
  }
  [[nodiscard]] double rms() const { return std::sqrt(squares / count); }
};

void compare_corners(const DrawingCamera& camera, const StereoCalibration& pair) {
  std::printf("\n| tilt | our corners: RMS, worst [px] | OpenCV's |\n|---:|---:|---:|\n");
  for (const int degrees : {0, 30, 45, 60, 70}) {
    Off ours, sample;
    int sample_missed = 0;
    for (int i = 0; i < 8; ++i) {
      const double about = i * M_PI / 4, tilt = degrees * M_PI / 180;
      const auto pose =
          BoardPose::at(kBoard, {tilt * std::cos(about), tilt * std::sin(about), 0}, {0, 0, 0.4});
      const cv::Mat image =
          camera.draw(printed(kBoard), pose, 2, 0.7, static_cast<std::uint64_t>(i + 1));
      const Corners truth = corners_of(kBoard, pose, pair.M1, pair.D1);
      if (const auto view = hc::vision::find_board(image, image, kBoard))
        ours.add(view->left, truth);
      Corners corners;
      if (!find_as_sample(image, kBoard, corners)) {
        ++sample_missed;
        continue;
      }
      refine_as_sample(image, corners);
      sample.add(corners, truth);
    }
    std::printf("| %d° | %.3f, %.2f; %d of 8 | %.3f, %.2f; %d of 8 |\n", degrees, ours.rms(),
                ours.worst, ours.count / 54, sample.rms(), sample.worst, 8 - sample_missed);
  }
}

void compare_calibrations(const DrawingCamera& left, const DrawingCamera& right,
                          const StereoCalibration& truth) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> spread(-1, 1);
  std::vector<BoardView> ours, sample;
  for (std::uint64_t i = 1; i <= 20; ++i) {
    const double z = 0.45 + 0.15 * spread(random);
    const auto pose =
        BoardPose::at(kBoard, {0.6 * spread(random), 0.6 * spread(random), 0.3 * spread(random)},
                      {0.05 + 0.2 * z * spread(random), 0.15 * z * spread(random), z});
    const cv::Mat l = left.draw(printed(kBoard), pose, 2, 0.7, 2 * i);
    const cv::Mat r = right.draw(printed(kBoard), pose.seen_by_right(truth), 2, 0.7, 2 * i + 1);
    if (const auto view = hc::vision::find_board(l, r, kBoard)) ours.push_back(*view);
    BoardView view;
    if (!find_as_sample(l, kBoard, view.left) || !find_as_sample(r, kBoard, view.right)) continue;
    refine_as_sample(l, view.left);
    refine_as_sample(r, view.right);
    sample.push_back(view);
  }
  std::printf(
      "\n| views of | focal lengths off by [%%] | baseline off by [%%] | RMS [px] | "
      "said: focal, baseline [%%] |\n|---|---:|---:|---:|---:|\n");
  const auto print = [&](const char* name, const StereoCalibration& c, const std::string& said) {
    std::printf("| %s | %.3f, %.3f | %.3f | %.3f | %s |\n", name,
                100 * (c.M1(0, 0) / truth.M1(0, 0) - 1), 100 * (c.M2(0, 0) / truth.M2(0, 0) - 1),
                100 * (cv::norm(c.T) / cv::norm(truth.T) - 1), c.rms, said.c_str());
  };
  for (const auto& [name, views] :
       {std::pair{"ours", &ours}, {"our fit, OpenCV's corners", &sample}}) {
    const auto found = bench::must(calibrate(*views, kBoard, truth.size));
    char said[64];
    std::snprintf(said, sizeof said, "%.3f, %.3f", 100 * found.deviations.focal,
                  100 * found.deviations.baseline);
    print((std::to_string(views->size()) + " views: " + name).c_str(), found.calibration, said);
  }
  std::vector<std::vector<cv::Point3f>> object(sample.size(), kBoard.corners());
  std::vector<Corners> lefts, rights;
  for (const auto& view : sample) {
    lefts.push_back(view.left);
    rights.push_back(view.right);
  }
  StereoCalibration c;
  cv::Mat M1 = cv::initCameraMatrix2D(object, lefts, truth.size, 0), D1, R, T, E, F;
  cv::Mat M2 = cv::initCameraMatrix2D(object, rights, truth.size, 0), D2;
  c.rms = cv::stereoCalibrate(object, lefts, rights, M1, D1, M2, D2, truth.size, R, T, E, F,
                              cv::CALIB_FIX_ASPECT_RATIO | cv::CALIB_ZERO_TANGENT_DIST |
                                  cv::CALIB_USE_INTRINSIC_GUESS | cv::CALIB_SAME_FOCAL_LENGTH |
                                  cv::CALIB_RATIONAL_MODEL | cv::CALIB_FIX_K3 | cv::CALIB_FIX_K4 |
                                  cv::CALIB_FIX_K5,
                              {cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 100, 1e-5});
  c.M1 = M1;
  c.M2 = M2;
  c.T = cv::Vec3d(T.reshape(1, 3));
  print((std::to_string(sample.size()) + " views: OpenCV's sample").c_str(), c, "–");
}

constexpr const char* kDictionary = "6X6_250";

/// The corners that OpenCV finds of a ChArUco board.
BoardView charuco_of_opencv(const cv::Mat& left, const cv::Mat& right, const Board& board) {
  const auto its = hc::vision::opencv_charuco(board);
  const auto words = hc::vision::opencv_dictionary(its);
  std::map<int, cv::Point2f> found[2];
  for (const auto& [image, corners] : {std::pair{&left, &found[0]}, {&right, &found[1]}}) {
    std::vector<Corners> markers;
    std::vector<int> ids, numbers;
    Corners places;
    cv::aruco::detectMarkers(*image, words, markers, ids);
    if (ids.empty()) continue;
    cv::aruco::interpolateCornersCharuco(markers, ids, *image, its, places, numbers);
    for (std::size_t i = 0; i < numbers.size(); ++i) (*corners)[numbers[i]] = places[i];
  }
  BoardView view;
  for (const auto& [number, place] : found[0])
    if (const auto same = found[1].find(number); same != found[1].end()) {
      view.numbers.push_back(static_cast<std::size_t>(number));
      view.left.push_back(place);
      view.right.push_back(same->second);
    }
  return view;
}

/// Corners of a board that is partly outside the images, and the calibration from them.
struct Trial {
  const char* name;
  std::function<BoardView(const cv::Mat& left, const cv::Mat& right)> find;
  Off off = {};
  double milliseconds = 0;
  std::vector<BoardView> views = {};
};

void compare_marked(const char* name, const Board& board, const DrawingCamera& left,
                    const DrawingCamera& right, const StereoCalibration& truth) {
  const auto finder = bench::must(hc::vision::MarkedBoardFinder::make(board, kDictionary));
  const auto print = printed(board, kDictionary);
  std::vector<Trial> trials = {{"ours", [&](const cv::Mat& l, const cv::Mat& r) {
                                  return finder.find(l, r).value_or(BoardView());
                                }}};
  if (board.kind == hc::vision::BoardKind::Charuco)
    trials.push_back({"OpenCV's", [&](const cv::Mat& l, const cv::Mat& r) {
                        return charuco_of_opencv(l, r, board);
                      }});
  std::mt19937 random(5);
  std::uniform_real_distribution<double> spread(-1, 1);
  constexpr std::uint64_t kViews = 20;
  for (std::uint64_t i = 1; i <= kViews; ++i) {
    const double z = 0.4 + 0.12 * spread(random);
    const auto pose =
        BoardPose::at(board, {0.6 * spread(random), 0.6 * spread(random), 0.3 * spread(random)},
                      {0.05 + 0.45 * z * spread(random), 0.35 * z * spread(random), z});
    const cv::Mat l = left.draw(print, pose, 2, 0.7, 2 * i);
    const cv::Mat r = right.draw(print, pose.seen_by_right(truth), 2, 0.7, 2 * i + 1);
    const Corners all = corners_of(board, pose, truth.M1, truth.D1);
    for (auto& trial : trials) {
      BoardView view;
      trial.milliseconds += bench::milliseconds([&] { view = trial.find(l, r); }) / kViews;
      constexpr std::size_t kLeast = 8;
      if (view.left.size() < kLeast) continue;
      for (std::size_t k = 0; k < view.left.size(); ++k)
        trial.off.add(view.left[k], all[view.number(k)]);
      trial.views.push_back(view);
    }
  }
  for (const auto& trial : trials) {
    const auto found = calibrate(trial.views, board, truth.size);
    std::printf("| %s: %s | %.0f | %zu of %d | %d | %.3f, %.2f | ", name, trial.name,
                trial.milliseconds, trial.views.size(), static_cast<int>(kViews), trial.off.count,
                trial.off.rms(), trial.off.worst);
    if (found)
      std::printf("%.3f, %.3f | %.3f |\n", 100 * (found->calibration.M1(0, 0) / truth.M1(0, 0) - 1),
                  100 * (found->calibration.M2(0, 0) / truth.M2(0, 0) - 1),
                  100 * (cv::norm(found->calibration.T) / cv::norm(truth.T) - 1));
    else
      std::printf("%s | |\n", found.error().detail.c_str());
  }
}

}  // namespace

int main() {
  const StereoCalibration pair = hc::vision::squinting();
  const DrawingCamera left(pair.M1, pair.D1, pair.size), right(pair.M2, pair.D2, pair.size);
  const cv::Mat board =
      left.draw(printed(kBoard), BoardPose::at(kBoard, {0.3, -0.2, 0.1}, {0, 0, 0.5}));
  cv::Mat incomplete = board.clone();
  incomplete.colRange(0, 330).setTo(110);
  std::printf(
      "| search of a pair | image | corners | ours [ms] | OpenCV's [ms] "
      "|\n|---|---|---|---:|---:|\n");
  time_search("the board", board, kBoard);
  time_search("another", board, {8, 6});
  time_search("another", board, {10, 7});
  time_search("another", board, {7, 5});
  time_search("incomplete", incomplete, kBoard);
  for (const char* name : {"left01.jpg", "aloeL.jpg", "board.jpg"}) {
    const cv::Mat image = photograph(name);
    if (image.empty()) continue;
    time_search(name, image, kBoard);
    time_search(name, image, {8, 6});
  }
  compare_corners(left, pair);
  compare_calibrations(left, right, pair);
  std::printf(
      "\n| incomplete boards: corners | search [ms] | views | corners | RMS, worst [px] | focal "
      "lengths off by [%%] | baseline [%%] |\n|---|---:|---:|---:|---:|---:|---:|\n");
  using hc::vision::BoardKind;
  compare_marked("ChArUco", {11, 8, 0.025, BoardKind::Charuco, 0.018}, left, right, pair);
  compare_marked("AprilGrid", {6, 5, 0, BoardKind::AprilGrid, 0.035, 0.3}, left, right, pair);
}
