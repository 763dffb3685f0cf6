// SPDX-License-Identifier: Apache-2.0
#pragma once
// Follows hands from image to image. Pure: times come from the caller; where they go back by more
// than a track's life, all tracks end.

#include <chrono>
#include <vector>

#include <hc/base/time.h>
#include <people/hand.h>

namespace hc::people {

/// A hand that was seen in several images.
struct HandTrack {
  int number = 0;  ///< from 1; never used again
  Hand hand;       ///< as it was seen last
  Time seen{};
};

/// Gives numbers to hands. A track moves on as it last did, for kMoving, and ends when it was not
/// seen for kLife.
class HandTracks {
 public:
  static constexpr std::chrono::milliseconds kLife{1000}, kMoving{300};
  /// Two hands of an image that overlap by more are one.
  static constexpr float kSame = 0.5F;
  /// Least overlap of a hand with the lost one that it continues: beside where that was expected by
  /// two thirds of its width, or a fist that has opened.
  static constexpr float kLeastOverlap = 0.2F;

  /// Where a hand is expected.
  struct Expected {
    int number = 0;
    Region region;
  };
  /// A hand in an image, and its track, if it was looked for where that was expected; 0: another.
  struct Sighting {
    int number = 0;
    Hand hand;
  };

  /// The tracks at a time, also those that were not seen in the last image.
  std::vector<Expected> expected(Time time);
  /// Takes all hands of an image: a hand without a track continues the one that it overlaps most of
  /// those that were not seen, or begins a new one. Of two tracks with the same hand the one that
  /// was seen before stays, or the older one.
  /// @returns the tracks that are seen in this image, by their numbers.
  std::vector<HandTrack> update(Time time, const std::vector<Sighting>& hands);

 private:
  struct Following {
    HandTrack track;
    cv::Point2f speed;                                 // of the middle of its region [px/s]
    Time seen_before{};                                // before track.seen
    bool is_seen = false;                              // in this image
    [[nodiscard]] cv::Point2f moved(Time time) const;  // since it was seen [px]
  };
  void end_old(Time time);
  void continue_lost(Time time, std::vector<Hand> hands);
  void end_doubles();
  static void correct(Following& one, Time time, const Hand& hand);

  std::vector<Following> all_;  // by number
  int last_ = 0;
};

}  // namespace hc::people
