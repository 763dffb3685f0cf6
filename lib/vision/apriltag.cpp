// SPDX-License-Identifier: Apache-2.0
#include <vision/marker_finder.h>

#include <algorithm>

extern "C" {
#include <apriltag/apriltag.h>
#include <apriltag/tag36h11.h>
}

namespace hc::vision {

struct AprilTagFinder::Detector {
  apriltag_family_t* family = tag36h11_create();
  apriltag_detector_t* detector = apriltag_detector_create();

  Detector() {
    constexpr int kBitsCorrected = 1;  // of 36; more gives false detections
    apriltag_detector_add_family_bits(detector, family, kBitsCorrected);
    detector->nthreads = 1;
  }
  Detector(const Detector&) = delete;
  Detector& operator=(const Detector&) = delete;
  ~Detector() {
    apriltag_detector_destroy(detector);
    tag36h11_destroy(family);
  }
};

AprilTagFinder::AprilTagFinder(double decimate) : detector_(std::make_shared<Detector>()) {
  detector_->detector->quad_decimate = static_cast<float>(decimate);
}

std::vector<Marker> AprilTagFinder::find(const cv::Mat& grey) const {
  std::vector<Marker> markers;
  constexpr int kLeastSide = 16;  // the library refuses smaller images
  if (grey.cols < kLeastSide || grey.rows < kLeastSide) return markers;
  const cv::Mat plain = grey.isContinuous() ? grey : grey.clone();
  image_u8_t image = {plain.cols, plain.rows, plain.cols, plain.data};
  zarray_t* found = apriltag_detector_detect(detector_->detector, &image);
  for (int i = 0; i < zarray_size(found); ++i) {
    apriltag_detection_t* tag = nullptr;
    zarray_get(found, i, static_cast<void*>(&tag));
    constexpr float kLeastMargin = 15;  // grey levels between bits; false tags have less
    if (tag->decision_margin < kLeastMargin) continue;
    Marker marker{MarkerKind::AprilTag, tag->id, {}};
    // The library starts at the bottom left; the centre of its first pixel is (0.5, 0.5).
    for (std::size_t corner = 0; corner < 4; ++corner)
      marker.corners[corner] = {tag->p[3 - corner][0] - 0.5, tag->p[3 - corner][1] - 0.5};
    refine_corners(plain, marker.corners);
    markers.push_back(marker);
  }
  apriltag_detections_destroy(found);
  return markers;
}

}  // namespace hc::vision
