// SPDX-License-Identifier: Apache-2.0
#include <people/face_finder.h>

namespace hc::people {

Result<FaceFinder> FaceFinder::make(std::unique_ptr<nets::Network> network) {
  // Source: MediaPipe, face_detection_short_range.pbtxt and face_detection_full_range.pbtxt.
  constexpr int kSideOfShortRange = 128;
  constexpr Ssd::Range kRange{-1, 1};
  auto ssd =
      HC_TRY(network->input()[0] == kSideOfShortRange
                 ? Ssd::make(std::move(network), {{8, 2}, {16, 6}}, Face::kPoints, kRange, "faces")
                 : Ssd::make(std::move(network), {{4, 1}}, Face::kPoints, kRange, "faces"));
  return FaceFinder(std::move(ssd));
}

std::vector<Face> FaceFinder::find(const cv::Mat& image, const cv::Rect& part, float least) {
  return merged(ssd_.find<Face>(image, part, least));
}

}  // namespace hc::people
