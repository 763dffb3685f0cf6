// SPDX-License-Identifier: Apache-2.0
#include "score.h"

#include <algorithm>
#include <utility>

#include <hc/base/format.h>
#include <hc/base/median.h>

namespace {

constexpr double kStraight = 0.95;  // a finger's length, of that of its bones
constexpr double kUp = 0.5;         // cosine of a finger's angle with the vertical
constexpr double kPause = 0.5;      // without a palm, until a stop may be cleared [s]

}  // namespace

bool is_palm_up(const hc::room::TrueHand& hand) {
  for (std::size_t root = hc::room::kIndexRoot; root < hand.joints.size();
       root += hc::room::kFingerJoints) {
    const auto* joints = &hand.joints[root];
    double bones = 0;
    for (std::size_t i = 0; i < 3; ++i) bones += (joints[i + 1] - joints[i]).norm();
    const Eigen::Vector3d finger = joints[3] - joints[0];
    if (finger.norm() < kStraight * bones || finger.z() < kUp * finger.norm()) return false;
  }
  return true;
}

void StopScore::see(double time, const std::vector<ShownHand>& hands) {
  if (!begin_) begin_ = time;
  last_ = time;
  std::vector<std::pair<int, int>> up;
  for (const auto& shown : hands) {
    if (!is_palm_up(shown.hand)) continue;
    palm_ = time;
    up.emplace_back(shown.hand.person, shown.hand.side);
    see_palm(time, shown);
  }
  for (auto& palm : palms_) {
    palm.is_up &= std::ranges::count(up, palm.whose) > 0;
    palm.has_stopped |= is_stopped_ && palm.is_held();
  }
  drop_ended(time);
}

void StopScore::see_palm(double time, const ShownHand& shown) {
  const std::pair whose(shown.hand.person, shown.hand.side);
  const auto& wrist = shown.hand.joints[0];
  const auto known = std::ranges::find_if(
      palms_, [&](const Palm& palm) { return palm.is_up && palm.whose == whose; });
  if (known != palms_.end()) {
    if ((wrist - known->at).norm() <= kStill) {
      known->see_border(time, shown.is_in_image);
      known->seen = time;
      return;
    }
    known->is_up = false;
  }
  palms_.push_back({whose, time, time, wrist, shown.is_in_image});
}

void StopScore::Palm::see_border(double time, bool is_whole) {
  if (must_stop() || (is_whole && is_in_image)) return;
  is_in_image = false;
  if (!is_whole) return whole_since.reset();
  if (!whole_since) whole_since = time;
  if (time - *whole_since < kHeld) return;
  is_in_image = true;
  begin = *std::exchange(whole_since, std::nullopt);
}

void StopScore::drop_ended(double time) {
  std::erase_if(palms_, [&](const Palm& palm) {
    if (palm.is_up || (palm.is_held() && time - palm.seen <= kLate)) return false;
    missed_ += palm.must_stop() && !palm.has_stopped;
    return true;
  });
}

void StopScore::stop(double time) {
  if (std::exchange(is_stopped_, true)) return;
  // Of several palms the first one stops, if it is whole in the image; the others cannot.
  const auto find_held = [this](bool in_image) {
    return std::ranges::find_if(palms_, [in_image](const Palm& palm) {
      return palm.is_in_image == in_image && palm.is_held() && !palm.has_stopped;
    });
  };
  auto first = find_held(true);
  if (first == palms_.end()) first = find_held(false);
  if (first == palms_.end()) {
    ++false_;
    return;
  }
  if (first->is_in_image)
    delays_.push_back(time - first->begin);
  else
    ++at_border_;
  for (auto& palm : palms_) palm.has_stopped |= palm.is_held();
}

bool StopScore::wants_to_go(double now) const {
  return is_stopped_ && now - palm_ > kPause;
}

std::array<double, 7> StopScore::numbers() const {
  double middle = -1, most = -1;
  if (!delays_.empty()) {
    middle = hc::median(delays_);
    most = *std::ranges::max_element(delays_);
  }
  const auto stopped = static_cast<double>(delays_.size());
  return {middle, most, stopped, stopped + missed_, double(false_), double(at_border_), duration()};
}

std::string StopScore::text() const {
  const auto [middle, most, stopped, palms, wrong, border, lasted] = numbers();
  auto others = hc::format("{} stops without a palm, {} by one at the border, in {:.0f} s", wrong,
                           border, lasted);
  if (palms == 0) return others;
  return hc::format("missed {} of {} palms, stopped after {:.3f} s median, {:.3f} s at most; ",
                    palms - stopped, palms, middle, most) +
         others;
}
