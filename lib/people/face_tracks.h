// SPDX-License-Identifier: Apache-2.0
#pragma once
// Follows faces from image to image. Pure: times come from the caller; where they go back by more
// than a track's life, all tracks are new.

#include <array>
#include <chrono>
#include <optional>
#include <vector>

#include <opencv2/core/matx.hpp>

#include <hc/base/time.h>
#include <people/face.h>

namespace hc::people {

/// A face that was seen in several images.
struct Track {
  int number = 0;  ///< from 1; never used again
  Face face;       ///< as it was seen last
  Time seen{};
};

/// Assigns the faces of each image to tracks: each to the one of which it is the most likely, by
/// place and width. So a face that comes out from behind another one within kLife keeps its track.
/// A track moves at a constant velocity between images. It ends when it was not seen for kLife and
/// in kMisses images, as there are few on a busy machine, or for kLongest.
class FaceTracks {
 public:
  /// Where a track is expected.
  struct Expected {
    int number = 0;
    cv::Rect2f box;
  };
  /// A face in an image. It continues a track, or begins one if `may_be_new`.
  struct Sighting {
    Face face;
    bool may_be_new = false;
  };

  static constexpr std::chrono::milliseconds kLife{1000}, kLongest{5000};
  static constexpr int kMisses = 3;
  /// Gate: a face farther from a track's predicted place [σ of the prediction; widths], and with
  /// less overlap with its box, is another one.
  static constexpr float kGate = 3, kWidestGate = 2, kLeastOverlap = 0.3F;

  /// @returns the tracks seen in this image, in the order of their faces.
  std::vector<Track> update(Time time, const std::vector<Sighting>& faces);

  /// Moves all tracks as the image has moved since the last one, by the camera's turn.
  /// @param H  of pixels from the last image to this one.
  void turn(const cv::Matx33f& H);

  /// Where the tracks are expected at a time, also those that were not seen in the last image.
  [[nodiscard]] std::vector<Expected> expected(Time time) const;

 private:
  /// A constant velocity, by a Kalman filter for each of the box's centre and width, all with the
  /// same gains.
  struct Following {
    Track track;
    cv::Point3f at, speed;        // centre and width [px], [px/s]
    std::array<float, 3> p = {};  // covariance of a place and its speed: (p0 p1; p1 p2)
    int misses = 0;               // images since it was seen
    [[nodiscard]] bool is_over(Time time) const;
    [[nodiscard]] cv::Point3f predicted(Time time) const;
    [[nodiscard]] std::array<float, 3> predicted_covariance(Time time) const;
    [[nodiscard]] cv::Rect2f box(Time time) const;
    /// -2 times the logarithm of the likelihood of a face; nothing outside the gate.
    [[nodiscard]] std::optional<float> cost(Time time, const Face& face) const;
    void correct(Time time, const Face& face);
  };
  std::vector<Following> all_;
  int last_ = 0;
};

}  // namespace hc::people
