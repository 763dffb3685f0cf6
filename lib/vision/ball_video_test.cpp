// SPDX-License-Identifier: Apache-2.0
// Balls in real videos, compared with positions marked by hand.
#include <vision/blob.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <map>
#include <optional>
#include <string>

#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

namespace hc::vision {
namespace {

/// The package as installed, or as unpacked by ./dev test.
std::string video(const std::string& name) {
  for (const std::string root : {"/usr", HC_SOURCE_DIR "/build/data/usr"})
    if (const auto path = root + "/share/pymecavideo/data/video/" + name;
        std::filesystem::exists(path))
      return path;
  return {};
}

/// The position of the ball, interpolated between the marked frames.
class Labels {
 public:
  explicit Labels(const std::string& name) {
    std::ifstream file(std::string(HC_SOURCE_DIR "/lib/vision/test_data/") + name);
    for (std::string line; std::getline(file, line);) {
      if (line.empty() || line[0] == '#') continue;
      int frame = 0;
      cv::Point2d at;
      const int fields = std::sscanf(line.c_str(), "%d,%lf,%lf", &frame, &at.x, &at.y);
      seen_[frame] = fields == 3 ? std::optional(at) : std::nullopt;
    }
  }
  [[nodiscard]] std::optional<cv::Point2d> at(int frame) const {
    auto next = seen_.lower_bound(frame);
    if (next == seen_.end()) return std::nullopt;
    if (next->first == frame || next == seen_.begin()) return next->second;
    const auto& [before, from] = *std::prev(next);
    if (!from || !next->second) return std::nullopt;
    const double share = static_cast<double>(frame - before) / (next->first - before);
    return *from + share * (*next->second - *from);
  }

 private:
  std::map<int, std::optional<cv::Point2d>> seen_;
};

struct VideoScore {
  int in_view = 0, found = 0, astray = 0;  // frames; astray: with a wrong blob
  double mean_error = 0;                   // of those found [px]
};

/// @param far  a blob farther away is not the ball [px].
/// @param change  applied to each image; takes the position of the ball.
VideoScore score_video(const std::string& path, const Labels& labels, const BlobColour& colour,
                       double min_area, double far,
                       const std::function<void(cv::Mat&, cv::Point2d)>& change = {}) {
  VideoScore score;
  BlobFinder finder(colour);
  cv::VideoCapture capture(path);
  cv::Mat frame, rgb;
  for (int number = 0; capture.read(frame); ++number) {
    cv::cvtColor(frame, rgb, cv::COLOR_BGR2RGB);
    const auto truth = labels.at(number);
    if (!truth) continue;
    ++score.in_view;
    if (change) change(rgb, *truth);
    const auto blob = finder.find(rgb, min_area);
    if (!blob) continue;
    const double error = std::hypot(blob->x - truth->x, blob->y - truth->y);
    if (error > far) {
      ++score.astray;
      continue;
    }
    ++score.found;
    score.mean_error += error;
  }
  if (score.found > 0) score.mean_error /= score.found;
  std::printf("[          ] found in %d of %d frames (%.1f %%), astray in %d, mean %.1f px off\n",
              score.found, score.in_view, 100.0 * score.found / score.in_view, score.astray,
              score.mean_error);
  return score;
}

TEST(BallVideo, TheYellowBallOnADarkFloor) {
  const auto path = video("balle-jbart.mp4");
  if (path.empty()) GTEST_SKIP() << "python3-mecavideo is not there: ./dev test unpacks it";
  BlobColour yellow;
  yellow.hue = 0.165;
  yellow.hue_width = 0.05;
  yellow.min_saturation = 0.2;
  yellow.min_value = 0.35;
  const auto score = score_video(path, Labels("balle-jbart.csv"), yellow, 60, 12);
  EXPECT_GE(score.in_view, 250);
  EXPECT_GE(score.found, 0.98 * score.in_view);
}

TEST(BallVideo, TheRedBallInAClassroom) {
  const auto path = video("balle1-vp9.avi");
  if (path.empty()) GTEST_SKIP() << "python3-mecavideo is not there: ./dev test unpacks it";
  BlobColour red;
  red.min_saturation = 0.45;
  const Labels labels("balle1-vp9.csv");
  const auto score = score_video(path, labels, red, 40, 8);
  EXPECT_GE(score.in_view, 240);
  EXPECT_GE(score.found, 0.98 * score.in_view);
  // A much larger red band at the edge.
  const auto beside = score_video(path, labels, red, 40, 8, [](cv::Mat& rgb, cv::Point2d at) {
    const int wide = rgb.cols / 8;
    rgb(cv::Rect(at.x > rgb.cols / 2.0 ? 0 : rgb.cols - wide, 0, wide, rgb.rows)) =
        cv::Scalar(190, 25, 20);
  });
  EXPECT_GE(beside.found, 0.95 * beside.in_view);
  // Half of the ball in shadow.
  const auto dark = score_video(path, labels, red, 20, 8, [](cv::Mat& rgb, cv::Point2d at) {
    const int x = std::clamp(cvRound(at.x), 0, rgb.cols - 1);
    rgb.colRange(x, rgb.cols) *= 0.3;
  });
  EXPECT_GE(dark.found, 0.95 * dark.in_view);
}

}  // namespace
}  // namespace hc::vision
