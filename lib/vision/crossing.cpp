// SPDX-License-Identifier: Apache-2.0
#include <vision/crossing.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include <opencv2/imgproc.hpp>

namespace hc::vision {

float room_around(cv::Point2f across, cv::Point2f down) {
  // The parallel lines at those distances touch a square of this size.
  const auto area = static_cast<float>(std::abs(across.cross(down)));
  return std::min(area / (std::abs(across.x) + std::abs(across.y)),
                  area / (std::abs(down.x) + std::abs(down.y)));
}

void refine_crossing(const cv::Mat& grey, float room, cv::Point2f& crossing) {
  constexpr float kShare = 0.6F;  // of the room, since lines are nearer on the far side
  constexpr float kLeast = 2, kMost = 11;
  const int half = static_cast<int>(std::clamp(kShare * room, kLeast, kMost));
  std::vector<cv::Point2f> one = {crossing};
  cv::cornerSubPix(grey, one, {half, half}, {-1, -1},
                   {cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 50, 1e-3});
  crossing = one[0];
}

}  // namespace hc::vision
