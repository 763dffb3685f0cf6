// SPDX-License-Identifier: Apache-2.0
#pragma once
// Finds and follows the faces in the images of a camera.

#include <optional>
#include <vector>

#include <opencv2/core/mat.hpp>

#include <people/face_finder.h>
#include <people/face_tracks.h>

namespace hc::people {

/// Follows known faces by the small network, around where they are expected, and searches for
/// others by the large one: in all parts of the first image, and then in one after the other. A
/// part has the shape of the large network's images: an image of that shape has one.
/// After the last part the small network searches the image with a margin for large faces, from 0.4
/// of its shorter side, which the large one sees only with a margin around them. A face counts
/// where the small network sees it, and a new one only if that one is sure; where the large one is
/// less sure, it must be surer.
///
/// Cost: 4 ms of a core for each known face, 15 ms for a part, 4 ms for large ones, and for each
/// possible face of a part (kMostFound) that is not known, or not sure, 4 ms, or 20 ms for a large
/// one.
class FaceSearch {
 public:
  /// How often a part is searched, while there are no faces and while some are followed. After a
  /// longer time without images, as many parts as would have been.
  static constexpr std::chrono::milliseconds kSearch{200}, kSweep{300};
  /// Faces that are followed, and faces that are taken from a part, the best ones.
  static constexpr std::size_t kMostFollowed = 8, kMostFound = 32;
  /// Least score by the large network of a place at which the small one looks, and of one where a
  /// face is likely.
  static constexpr float kPossible = 0.3F, kLikely = 0.5F;
  /// Least score by the small network of a new face where one is likely, and elsewhere. In rooms
  /// without people it gives 0.49 and 0.74 at most to what the large one takes for faces. Source:
  /// bench/faces.
  static constexpr float kSure = 0.65F, kSureElsewhere = 0.8F;

  /// Errors: those of FaceFinder::read_wide().
  static Result<FaceSearch> read();
  /// @param wide  the large network, for images of any shape. @param near  the small one.
  FaceSearch(FaceFinder wide, FaceFinder near) : wide_(std::move(wide)), near_(std::move(near)) {}

  /// The faces of the next image, (height, width) of u8, RGB or grey, of any size.
  /// @param least  of the scores by the small network.
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
  /// The same face by the small network, whose points are more precise; nothing if it sees none.
  std::optional<Face> refined(const cv::Mat& image, const Face& face, float least);
  /// Adds large faces that are not known.
  void add_large(Time time, const cv::Mat& image, float least, std::vector<Sighting>& faces);
  /// Adds a face of the large network, unless it is known. It may be new if the small one is sure.
  void add(const cv::Mat& image, const Face& face, float least, std::vector<Sighting>& faces);

  FaceFinder wide_, near_;
  FaceTracks tracks_;
  std::size_t next_part_ = 0;
  Time swept_{};
};

}  // namespace hc::people
