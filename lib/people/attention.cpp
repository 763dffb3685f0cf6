// SPDX-License-Identifier: Apache-2.0
#include <people/attention.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace hc::people {
namespace {

constexpr double kFade = 0.4;    // a sound counts 1/e after this time [s]
constexpr double kSpeaks = 2.5;  // sounds that make a speaker: an eighth of a second of speech

}  // namespace

void Attention::see(int track, Time time, const Place& place) {
  Person& person = people_[track];
  person.place = place;
  person.seen = time;
}

void Attention::hear(Time time, double pan) {
  Person* from = nullptr;
  double apart = kApart;
  for (auto& [track, person] : people_) {
    const double angle = std::abs(std::remainder(pan - person.place.pan, 2 * std::numbers::pi));
    if (angle > apart) continue;
    apart = angle;
    from = &person;
  }
  if (from == nullptr) return;
  from->heard = speech(*from, time) + 1;
  from->heard_at = time;
}

double Attention::speech(const Person& person, Time time) {
  const double passed = seconds(std::chrono::abs(time - person.heard_at));
  return person.heard * std::exp(-passed / kFade);
}

std::optional<int> Attention::speaker(Time time) const {
  std::optional<int> loudest;
  double most = kSpeaks;
  for (const auto& [track, person] : people_) {
    const double heard = speech(person, time);
    if (heard < most) continue;
    most = heard;
    loudest = track;
  }
  return loudest;
}

int Attention::nearest() const {
  return std::min_element(people_.begin(), people_.end(),
                          [](const auto& a, const auto& b) {
                            return a.second.place.distance < b.second.place.distance;
                          })
      ->first;
}

bool Attention::is_clearly_nearer(int track, int than) const {
  return people_.at(track).place.distance + options_.nearer < people_.at(than).place.distance;
}

void Attention::look_at(int track, Reason reason, Time time) {
  if (!choice_ || choice_->track != track) since_ = time;
  choice_ = Choice{track, reason};
}

std::optional<Attention::Choice> Attention::choose(Time time) {
  std::erase_if(
      people_, [&](const auto& each) { return std::chrono::abs(time - each.second.seen) > kLife; });
  if (choice_ && !people_.contains(choice_->track)) choice_.reset();
  if (people_.empty()) return std::nullopt;
  const auto kept = std::chrono::abs(time - since_);
  const auto speaks = speaker(time);
  if (held_ && people_.contains(*held_)) {
    look_at(*held_, Reason::Held, time);
  } else if (speaks) {
    if (!choice_ || *speaks == choice_->track || kept >= options_.hold_from_speaker)
      look_at(*speaks, Reason::Speaks, time);
  } else if (const int other = nearest();
             !choice_ || (kept >= options_.hold && is_clearly_nearer(other, choice_->track))) {
    look_at(other, Reason::Nearest, time);
  } else {
    choice_->reason = Reason::Nearest;  // by less than the margin, or it is kept
  }
  return choice_;
}

std::string_view text(Attention::Reason reason) {
  switch (reason) {
    case Attention::Reason::Nearest:
      return "the nearest";
    case Attention::Reason::Speaks:
      return "the speaker";
    case Attention::Reason::Held:
      return "held";
  }
  return "";
}

}  // namespace hc::people
