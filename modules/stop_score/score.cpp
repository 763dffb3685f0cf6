// SPDX-License-Identifier: Apache-2.0
#include "score.h"

#include <algorithm>
#include <utility>

#include <hc/base/format.h>
#include <hc/base/median.h>

namespace {

constexpr std::size_t kWrist = 0, kFirstFinger = 5, kPerFinger = 4;
constexpr double kStraight = 0.95;  // a finger's length, of that of its bones
constexpr double kUp = 0.5;         // cosine of a finger's angle with the vertical
constexpr double kPause = 0.5;      // without a palm, until a stop may be cleared [s]

}  // namespace

bool is_palm_up(const TrueHand& hand) {
  const auto& joints = hand.joints;
  for (std::size_t root = kFirstFinger; root < kHandJoints; root += kPerFinger) {
    double bones = 0;
    for (std::size_t i = root; i + 1 < root + kPerFinger; ++i)
      bones += (joints[i + 1] - joints[i]).norm();
    const Eigen::Vector3d finger = joints[root + kPerFinger - 1] - joints[root];
    if (finger.norm() < kStraight * bones || finger.z() < kUp * finger.norm()) return false;
  }
  return true;
}

void StopScore::see(double time, const std::vector<TrueHand>& hands) {
  if (!begin_) begin_ = time;
  last_ = time;
  std::vector<std::pair<int, int>> up;
  for (const auto& hand : hands) {
    if (!is_palm_up(hand)) continue;
    palm_ = time;
    if (!hand.is_in_image) continue;
    up.push_back(hand.whose);
    see_palm(time, hand);
  }
  for (auto& palm : palms_) {
    palm.is_up &= std::ranges::count(up, palm.whose) > 0;
    palm.has_stopped |= is_stopped_ && palm.is_held();
  }
  drop_ended(time);
}

void StopScore::see_palm(double time, const TrueHand& hand) {
  const auto known = std::ranges::find_if(
      palms_, [&](const Palm& palm) { return palm.is_up && palm.whose == hand.whose; });
  if (known != palms_.end()) {
    if ((hand.joints[kWrist] - known->at).norm() <= kStill) {
      known->seen = time;
      return;
    }
    known->is_up = false;
  }
  palms_.push_back({hand.whose, time, time, hand.joints[kWrist]});
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
  // Of several palms the first one stops; the others cannot.
  const auto first = std::ranges::find_if(
      palms_, [](const Palm& palm) { return palm.is_held() && !palm.has_stopped; });
  if (first == palms_.end()) {
    ++false_;
    return;
  }
  delays_.push_back(time - first->begin);
  for (auto& palm : palms_) palm.has_stopped |= palm.is_held();
}

bool StopScore::wants_to_go(double now) const {
  return is_stopped_ && now - palm_ > kPause;
}

std::array<double, 6> StopScore::numbers() const {
  double middle = -1, most = -1;
  if (!delays_.empty()) {
    middle = hc::median(delays_);
    most = *std::ranges::max_element(delays_);
  }
  const auto stopped = static_cast<double>(delays_.size());
  return {middle, most, stopped, stopped + missed_, double(false_), duration()};
}

std::string StopScore::text() const {
  const auto [middle, most, stopped, palms, wrong, lasted] = numbers();
  const auto others = hc::format("{} stops without a palm in {:.0f} s", wrong, lasted);
  if (palms == 0) return others;
  return hc::format("missed {} of {} palms, stopped after {:.3f} s median, {:.3f} s at most; ",
                    palms - stopped, palms, middle, most) +
         others;
}
