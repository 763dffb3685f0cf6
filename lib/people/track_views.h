// SPDX-License-Identifier: Apache-2.0
#pragma once
// The embeddings that the views of tracked faces have given. Pure: times come from the caller.

#include <chrono>
#include <map>
#include <optional>
#include <vector>

#include <people/embedding.h>
#include <people/face_tracks.h>
#include <people/gallery.h>

namespace hc::people {

/// Says which face to describe next, since a description costs more than a search, and keeps the
/// last few of each track. After two faces were close, or one was hidden by the other, their tracks
/// may have changed places: they are unsure until a view has shown that they have not, and begin
/// again where it may be another person's.
class TrackViews {
 public:
  /// Views that are averaged; a track of fewer, or an unsure one, is described in each image, if it
  /// is its turn.
  static constexpr std::size_t kViews = 5;
  /// Views before a track is sure.
  static constexpr std::size_t kLeast = 3;
  /// Time between the views of a track that has kViews.
  static constexpr std::chrono::milliseconds kPause{1000};
  /// Maximum distance of a view from the mean of the others of its track; more than kSamePerson,
  /// since one in ten views of a head that turns is farther than that. A sure track ignores a
  /// single view that is farther.
  static constexpr float kApart = 0.4F;
  /// A track that is not seen in the images of a longer time may go on with another person; where
  /// images are that rare, one that may have been passed by another face in between.
  static constexpr std::chrono::milliseconds kGap{300};

  /// The track to describe now, by its place in `seen`; nothing if all are known well enough.
  /// Forgets tracks that have ended.
  /// @param all  where the tracks are expected now, also the hidden ones.
  [[nodiscard]] std::optional<std::size_t> due(Time time, const std::vector<Track>& seen,
                                               const std::vector<FaceTracks::Expected>& all);
  /// Takes a description. A view that is far from the others replaces them all if their track is
  /// unsure, or is the second such.
  void add(int track, Time time, const Embedding& view);

  /// The last views of a track, at most kViews.
  [[nodiscard]] const std::vector<Embedding>& views(int track) const;
  /// Whether a track is of one person, as far as is known, so that it is sure after some more views
  /// or images that are less rare.
  [[nodiscard]] bool may_become_sure(int track) const;
  /// Their mean; nothing while it is not sure whose they are.
  [[nodiscard]] std::optional<Embedding> embedding(int track) const;

 private:
  struct Views {
    std::vector<Embedding> last;
    Time seen, described;
    bool is_close = false, is_sure = false, was_apart = false;
    bool may_be_another = false;  // than at first
  };
  /// @param passed  since the last image, in which faces may have moved unseen. [s]
  void doubt_close(const std::vector<FaceTracks::Expected>& all, double passed);

  std::map<int, Views> tracks_;
  std::optional<Time> last_;  // image
};

}  // namespace hc::people
