// SPDX-License-Identifier: Apache-2.0
#pragma once
// Finds and follows the hands in the images of a camera.

#include <chrono>
#include <map>
#include <optional>
#include <vector>

#include <opencv2/core/mat.hpp>

#include <people/hand_landmarks.h>
#include <people/hand_tracks.h>
#include <people/palm_finder.h>
#include <people/search_places.h>
#include <people/sign.h>

namespace hc::people {

/// When to search for palms. Pure.
class SearchTimes {
 public:
  /// Between searches, while somebody may be in view, and where no face is, though a hand may be.
  static constexpr std::chrono::milliseconds kWithPeople{100}, kWithoutPeople{1000};
  /// Between looks at the other hands while a palm may be a command. Shorter than
  /// HandCommand::kUnseen, as one of them may become another palm.
  static constexpr std::chrono::milliseconds kOthers{150};
  /// A pause of searches after a palm came up. It may be a command: HandCommand::kHold, in many
  /// images.
  static constexpr std::chrono::milliseconds kPalmPause{700};

  /// Whether it is time to search; the next time is counted from then.
  /// @param is_palm  whether one of the hands that are followed is open and up.
  bool is_due(Time time, bool has_people, bool is_palm);
  /// Whether it is time to look at hands that are not open, too; the next time is counted from
  /// then. Asked before is_due(), which waits for an image in which all were looked at.
  bool are_others_due(Time time);

 private:
  std::optional<Time> last_, others_;
  bool is_command_ = false;  // a palm, in the last image
  bool skips_others_ = false;
  SignHold palm_{kPalmPause};
};

/// Follows known hands by the network of their points alone, and searches for others now and then.
/// While enough are followed it searches for one more that is open and up, since that is a command
/// to stop, and follows it as long as it is. While a palm may be a command, other hands are looked
/// at less often, and are missing from the images in between.
///
/// Cost: 15 ms for each known hand, of one core; 23 ms for a search and 30 ms for each other hand
/// that it sees; 1 ms for an image.
class HandSearch {
 public:
  /// @param most  hands that are followed, beside one that is open and up.
  HandSearch(PalmFinder palms, HandLandmarks landmarks, std::size_t most = 2)
      : palms_(std::move(palms)), landmarks_(std::move(landmarks)), most_(most) {}

  void set_most(std::size_t most) { most_ = most; }
  /// The hands in the next image, (height, width) of u8, RGB or grey, of any size.
  /// @param faces  boxes of the faces in view; nothing: unknown.
  std::vector<HandTrack> look(Time time, const cv::Mat& image,
                              const std::optional<std::vector<cv::Rect2f>>& faces = {});
  /// The hand in a region, such as that of a known hand in the image of the other eye.
  Hand look_at(const cv::Mat& image, const Region& region) {
    return landmarks_.find(image, region);
  }

 private:
  void search(const cv::Mat& image, const std::vector<cv::Rect2f>& faces,
              std::vector<HandTracks::Sighting>& hands);
  /// Takes a hand that was found, if it is to be followed.
  void add(const HandTracks::Sighting& found, std::vector<HandTracks::Sighting>& hands) const;

  PalmFinder palms_;
  HandLandmarks landmarks_;
  std::size_t most_;
  HandTracks tracks_;
  std::map<int, Time> open_;  // when tracks were last open and up
  SearchTimes times_;
  SearchPlaces places_;
};

}  // namespace hc::people
