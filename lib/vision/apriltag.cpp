// SPDX-License-Identifier: Apache-2.0
#include <vision/marker_finder.h>

#include <algorithm>
#include <cstdint>

#include <opencv2/imgproc.hpp>

extern "C" {
#include <apriltag/apriltag.h>
#include <apriltag/tag36h11.h>
}

namespace hc::vision {

namespace {

/// The family with a black border of two cells.
apriltag_family_t* create_wide() {
  apriltag_family_t* family = tag36h11_create();
  family->width_at_border += 2;
  family->total_width += 2;
  for (std::uint32_t i = 0; i < family->nbits; ++i) {
    ++family->bit_x[i];
    ++family->bit_y[i];
  }
  return family;
}

}  // namespace

struct AprilTagFinder::Detector {
  apriltag_detector_t* detector = apriltag_detector_create();
  std::vector<apriltag_family_t*> families = {tag36h11_create()};

  explicit Detector(bool wide_borders) {
    if (wide_borders) families.push_back(create_wide());
    constexpr int kBitsCorrected = 1;  // of 36; more gives false detections
    for (auto* family : families)
      apriltag_detector_add_family_bits(detector, family, kBitsCorrected);
    detector->nthreads = 1;
  }
  Detector(const Detector&) = delete;
  Detector& operator=(const Detector&) = delete;
  ~Detector() {
    apriltag_detector_destroy(detector);
    for (auto* family : families) tag36h11_destroy(family);
  }
};

AprilTagFinder::AprilTagFinder(double decimate, bool wide_borders)
    : detector_(std::make_shared<Detector>(wide_borders)) {
  detector_->detector->quad_decimate = static_cast<float>(decimate);
}

std::vector<Marker> AprilTagFinder::find(const cv::Mat& grey) const {
  std::vector<Marker> markers;
  constexpr int kLeastSide = 16;  // the library refuses smaller images
  if (grey.cols < kLeastSide || grey.rows < kLeastSide) return markers;
  const cv::Mat plain = grey.isContinuous() ? grey : grey.clone();
  cv::Mat apart = plain;
  // In a grid, squares touch the corners of tags, and blurred they are one area.
  if (detector_->families.size() > 1)
    cv::dilate(plain, apart = cv::Mat(), cv::getStructuringElement(cv::MORPH_CROSS, {3, 3}));
  image_u8_t image = {apart.cols, apart.rows, apart.cols, apart.data};
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
    // Of some tags, both families read the cells right.
    if (std::none_of(markers.begin(), markers.end(), [&](const Marker& other) {
          return other.id == marker.id &&
                 cv::norm(other.middle() - marker.middle()) < marker.mean_side() / 4;
        }))
      markers.push_back(marker);
  }
  apriltag_detections_destroy(found);
  return markers;
}

cv::Mat apriltag_cells(int id) {
  apriltag_family_t* family = tag36h11_create();
  cv::Mat cells(6, 6, CV_8U, cv::Scalar(0));
  for (std::uint32_t i = 0; i < family->nbits; ++i)
    if ((family->codes[id] >> (family->nbits - 1 - i)) & 1)
      cells.at<std::uint8_t>(static_cast<int>(family->bit_y[i]) - 1,
                             static_cast<int>(family->bit_x[i]) - 1) = 255;
  tag36h11_destroy(family);
  return cells;
}

}  // namespace hc::vision
