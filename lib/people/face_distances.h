// SPDX-License-Identifier: Apache-2.0
#pragma once
// How far away faces are: by both eyes, or by their size. Pure: times come from the caller.

#include <map>
#include <optional>
#include <vector>

#include <hc/base/time.h>
#include <people/face.h>
#include <people/face_tracks.h>

namespace hc::people {

/// A rectified pair of cameras.
struct FacePair {
  float focal = 0;     ///< [px]
  float baseline = 0;  ///< [m]
};

/// Estimated from the width of a face, which is about 15 cm. [m]
float distance_by_size(const Face& face, const FacePair& pair);

/// Where a face of the left image is in the right one, by its size.
cv::Rect2f expected_in_right(const Face& left, const FacePair& pair);

/// The distance of a face that both eyes see, of those found in the right image; nothing if none of
/// them is at the same height, of the same size and to the left. [m]
std::optional<float> distance_by_eyes(const Face& left, const std::vector<Face>& right,
                                      const FacePair& pair);

/// Smoothed distances of tracks. A search for a face in the right image takes as long as in the
/// left one, so not each image is searched.
class FaceDistances {
 public:
  /// Time constant. [s]
  static constexpr double kSmoothing = 0.2;

  /// The tracks to look for in the right image of a time, by their places in `seen`: each once in
  /// kSmoothing, the longest ago first, and in an image a quarter of all at most, or one.
  std::vector<std::size_t> due(Time time, const std::vector<Track>& seen);
  /// Takes a distance by both eyes.
  void add(int track, Time time, float distance);
  /// The distance of a track now; nothing if both eyes have not seen it for a second.
  [[nodiscard]] std::optional<float> find(int track, Time time) const;

 private:
  struct Known {
    Time time;
    float distance = 0;
  };
  std::map<int, Known> known_;
  std::map<int, Time> looked_;  // when a track was due last
};

}  // namespace hc::people
