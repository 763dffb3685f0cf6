// SPDX-License-Identifier: Apache-2.0
#include <people/palm_finder.h>

#include <algorithm>
#include <cmath>

namespace hc::people {

Region region_of(const Palm& palm) {
  constexpr float kLarger = 2.6F, kAhead = 0.5F;
  const cv::Point2f fingers = palm.points[Palm::Middle] - palm.points[Palm::Wrist];
  const float turn = std::atan2(fingers.x, -fingers.y);
  const cv::Point2f up(std::sin(turn), -std::cos(turn));
  const cv::Point2f middle = (palm.box.tl() + palm.box.br()) / 2;
  return {middle + up * (kAhead * palm.box.height),
          kLarger * std::max(palm.box.width, palm.box.height), turn};
}

Result<PalmFinder> PalmFinder::make(std::unique_ptr<nets::Network> network) {
  // Source: MediaPipe, palm_detection_cpu.pbtxt.
  auto ssd =
      HC_TRY(Ssd::make(std::move(network), {{8, 2}, {16, 6}}, Palm::kPoints, {0, 1}, "palms"));
  return PalmFinder(std::move(ssd));
}

std::vector<Palm> PalmFinder::find(const cv::Mat& image, const cv::Rect& part, float least) {
  return merged(ssd_.find<Palm>(image, part, least));
}

}  // namespace hc::people
