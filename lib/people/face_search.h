// SPDX-License-Identifier: Apache-2.0
#pragma once
// Finds and follows the faces in the images of a camera.

#include <vector>

#include <opencv2/core/mat.hpp>

#include <people/face_finder.h>
#include <people/face_tracks.h>

namespace hc::people {

/// Follows known faces by the small network, around where they are expected, and searches for
/// others by the large one: in all parts of the first image, and then in one after the other. A new
/// face is one only if the small network is sure of it, too: in one of 80 images of rooms without
/// people the large one alone sees a face.
///
/// Cost: 5 ms of a core for each known face, and 15 ms for a part.
class FaceSearch {
 public:
  /// How often a part is searched, while there are no faces and while some are followed. After a
  /// longer time without images, as many parts as would have been.
  static constexpr std::chrono::milliseconds kSearch{150}, kSweep{200};
  static constexpr std::size_t kMostFollowed = 8;
  /// Least score of a new face by the small network. In 3,000 images of rooms without people it
  /// gave 0.61 at most to what the large one took for a face, in photographs 0.75 at least to
  /// faces.
  static constexpr float kSure = 0.65F;

  /// @param wide  with face_detection_full_range. @param near  with face_detection_short_range.
  FaceSearch(FaceFinder wide, FaceFinder near) : wide_(std::move(wide)), near_(std::move(near)) {}

  /// The faces of the next image, (height, width) of u8, RGB or grey, of any size.
  /// @param least  of their scores.
  /// @param turn  of the camera since the last image. @see FaceTracks::turn()
  std::vector<Track> look(Time time, const cv::Mat& image, float least = 0.5F,
                          const cv::Matx33f& turn = cv::Matx33f::eye());
  /// Where the tracks are expected at a time, also those of faces that are hidden.
  [[nodiscard]] std::vector<FaceTracks::Expected> expected(Time time) const {
    return tracks_.expected(time);
  }
  /// Whether a track has not ended at a time.
  [[nodiscard]] bool follows(int track, Time time) const;
  /// The faces around a place, such as that of a known face in the image of the other eye.
  std::vector<Face> look_around(const cv::Mat& image, const cv::Rect2f& box, float least = 0.5F);

 private:
  using Sighting = FaceTracks::Sighting;

  std::vector<Sighting> followed(Time time, const cv::Mat& image, float least);
  /// A face of the large network as the small one sees it, whose points are more precise.
  Sighting refined(const cv::Mat& image, const Face& face);
  /// Adds a face of the large network.
  void add(const cv::Mat& image, const Face& face, std::vector<Sighting>& faces);

  FaceFinder wide_, near_;
  FaceTracks tracks_;
  std::size_t next_part_ = 0;
  Time swept_{};
};

}  // namespace hc::people
