// SPDX-License-Identifier: Apache-2.0
#include <people/face_finder.h>

#include <algorithm>
#include <array>

#include <nets/weights.h>

namespace hc::people {

Result<FaceFinder> FaceFinder::read_near() {
  auto network =
      HC_TRY(nets::Network::read(nets::weights_path("face_detection_short_range.tflite")));
  return make(std::move(network));
}

Result<FaceFinder> FaceFinder::read_wide() {
  constexpr std::array kSize{192, 256};
  auto network =
      HC_TRY(nets::Network::read(nets::weights_path("face_detection_full_range.tflite"), kSize));
  return make(std::move(network));
}

Result<FaceFinder> FaceFinder::make(std::unique_ptr<nets::Network> network) {
  // Source: MediaPipe, face_detection_short_range.pbtxt and face_detection_full_range.pbtxt.
  constexpr std::array kShortRange{128, 128};  // height and width of images
  constexpr Ssd::Range kRange{-1, 1};
  auto ssd =
      HC_TRY(std::equal(kShortRange.begin(), kShortRange.end(), network->input().begin())
                 ? Ssd::make(std::move(network), {{8, 2}, {16, 6}}, Face::kPoints, kRange, "faces")
                 : Ssd::make(std::move(network), {{4, 1}}, Face::kPoints, kRange, "faces"));
  return FaceFinder(std::move(ssd));
}

std::vector<Face> FaceFinder::find(const cv::Mat& image, const cv::Rect& part, float least) {
  return merged(ssd_.find<Face>(image, part, least));
}

}  // namespace hc::people
