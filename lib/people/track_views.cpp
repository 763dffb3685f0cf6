// SPDX-License-Identifier: Apache-2.0
#include <people/track_views.h>

#include <algorithm>
#include <utility>

namespace hc::people {
namespace {

/// Whether two faces are so close that a search may take one for the other.
/// @param widths  of the larger one.
bool are_close(const cv::Rect2f& a, const cv::Rect2f& b, float widths) {
  const cv::Point2f apart = (a.tl() + a.br() - b.tl() - b.br()) / 2;
  const float most = widths * std::max(a.width, b.width);
  return apart.dot(apart) < most * most;
}

}  // namespace

void TrackViews::doubt_close(const std::vector<FaceTracks::Expected>& all, double passed) {
  constexpr float kClose = 1.5F, kApproach = 13;  // [widths of a face], [1/s]: 2 m/s
  const bool is_rare = passed > seconds(kGap);
  const float widths = kClose + (is_rare ? kApproach * static_cast<float>(passed) : 0);
  for (const FaceTracks::Expected& one : all) {
    const auto found = tracks_.find(one.number);
    if (found == tracks_.end()) continue;
    Views& views = found->second;
    const auto is_any_within = [&](float most) {
      return std::any_of(all.begin(), all.end(), [&](const FaceTracks::Expected& other) {
        return one.number != other.number && are_close(one.box, other.box, most);
      });
    };
    views.is_close = is_any_within(widths);
    views.is_sure &= !views.is_close;
    views.may_be_another |= is_any_within(kClose);
  }
}

std::optional<std::size_t> TrackViews::due(Time time, const std::vector<Track>& seen,
                                           const std::vector<FaceTracks::Expected>& all) {
  const Time before = std::exchange(last_, time).value_or(time);
  for (const Track& track : seen) {
    const auto [found, is_new] = tracks_.try_emplace(track.number);
    Views& views = found->second;
    const Time last_seen = std::exchange(views.seen, time);
    if (is_new || last_seen == before || std::chrono::abs(time - last_seen) <= kGap) continue;
    views.is_sure = false;
  }
  std::erase_if(tracks_, [&](const auto& each) {
    return std::ranges::find(all, each.first, &FaceTracks::Expected::number) == all.end();
  });
  doubt_close(all, seconds(std::chrono::abs(time - before)));
  // Few views first, then long ago.
  const auto order = [&](std::size_t place) {
    const Views& views = tracks_.at(seen[place].number);
    return std::pair(views.last.size(), views.described);
  };
  std::optional<std::size_t> next;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const Views& views = tracks_.at(seen[i].number);
    const bool is_known = views.is_sure && views.last.size() == kViews;
    if (is_known && std::chrono::abs(time - views.described) < kPause) continue;
    if (!next || order(i) < order(*next)) next = i;
  }
  return next;
}

void TrackViews::add(int track, Time time, const Embedding& view) {
  Views& views = tracks_[track];
  const bool is_apart = !views.last.empty() && distance(view, mean(views.last)) > kApart;
  views.described = views.seen = time;
  if (std::exchange(views.was_apart, is_apart) < is_apart && views.is_sure) return;
  if (is_apart) {
    views.last.clear();
    views.may_be_another = true;
  }
  views.last.push_back(view);
  if (views.last.size() > kViews) views.last.erase(views.last.begin());
  views.is_sure = !views.is_close && views.last.size() >= kLeast;
}

const std::vector<Embedding>& TrackViews::views(int track) const {
  static const std::vector<Embedding> kNone;
  const auto found = tracks_.find(track);
  return found == tracks_.end() ? kNone : found->second.last;
}

bool TrackViews::may_become_sure(int track) const {
  const auto found = tracks_.find(track);
  return found == tracks_.end() || !found->second.may_be_another;
}

std::optional<Embedding> TrackViews::embedding(int track) const {
  const auto found = tracks_.find(track);
  if (found == tracks_.end() || !found->second.is_sure) return std::nullopt;
  return mean(found->second.last);
}

}  // namespace hc::people
