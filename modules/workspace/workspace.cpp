// SPDX-License-Identifier: Apache-2.0
#include "workspace.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <iterator>
#include <string>
#include <utility>

namespace {

std::string two_digits(double value) {
  std::array<char, 64> text;
  const auto end =
      std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::fixed, 2).ptr;
  return {text.data(), end};
}

}  // namespace

hc::Status Workspace::check(std::int32_t mode, double salience) {
  if (!(salience >= 0 && salience <= 1)) {  // nor is not-a-number
    ++refused_.salience;
    return hc::Error{hc::Code::Malformed, "salience " + std::to_string(salience) + " of mode " +
                                              std::to_string(mode) + " is not from 0 to 1"};
  }
  if (mode <= 0) {
    ++refused_.mode;
    return hc::Error{hc::Code::Malformed,
                     "a bid is for a mode from 1 on, not " + std::to_string(mode)};
  }
  return {};
}

hc::Status Workspace::bid(std::int32_t mode, double salience, hc::MonotonicTime now) {
  if (auto checked = check(mode, salience); !checked) return checked;
  if (salience == 0) {
    bids_.erase(mode);
    return {};
  }
  if (bids_.size() >= kMostModes && !bids_.contains(mode)) {
    ++refused_.crowded;
    return hc::Error{hc::Code::TooLarge, "mode " + std::to_string(mode) + ": " +
                                             std::to_string(kMostModes) + " others have bids"};
  }
  bids_[mode] = {salience, now};
  return {};
}

hc::Status Workspace::bid_of_person(std::int32_t mode, double salience, hc::MonotonicTime now) {
  if (auto checked = check(mode, salience); !checked) return checked;
  if (salience != 0)
    person_ = {mode, Bid{salience, now}};
  else if (person_ && person_->first == mode)
    person_.reset();
  return {};
}

void Workspace::drop_expired(hc::MonotonicTime now) {
  for (auto bid = bids_.begin(); bid != bids_.end();)
    bid = now - bid->second.made >= options_.expiry ? bids_.erase(bid) : std::next(bid);
  if (person_ && now - person_->second.made >= options_.person_expiry) person_.reset();
}

std::int32_t Workspace::winner(hc::MonotonicTime now) const {
  if (is_stopped_) return 0;
  if (person_) return person_->first;
  auto best = std::max_element(bids_.begin(), bids_.end(), [](const auto& a, const auto& b) {
    return a.second.salience < b.second.salience;  // gives the first of equal ones
  });
  if (best == bids_.end()) return 0;
  auto holder = bids_.find(focus_);
  if (holder == bids_.end()) return best->first;
  bool challenges = best->second.salience > holder->second.salience + options_.margin;
  return challenges && now - since_ >= options_.dwell ? best->first : focus_;
}

bool Workspace::decide(hc::MonotonicTime now) {
  drop_expired(now);
  std::int32_t next = winner(now);
  if (next == focus_) return false;
  before_ = std::exchange(focus_, next);
  since_ = now;
  return true;
}

std::string Workspace::last_change(const std::map<std::int32_t, std::string>& names) const {
  auto text = [&](std::int32_t mode) {
    auto name = names.find(mode);
    std::string words = name == names.end() ? "mode " + std::to_string(mode) : name->second;
    if (person_ && person_->first == mode) return words + " (a person's bid)";
    auto bid = bids_.find(mode);
    return bid == bids_.end() ? words : words + " (" + two_digits(bid->second.salience) + ")";
  };
  if (focus_ == 0) return is_stopped_ ? "none; stopped" : "none; no bid is left";
  const bool is_contested = before_ != 0 && bids_.contains(before_);
  if (!is_contested) return text(focus_) + (before_ == 0 ? "" : "; no bid of " + text(before_));
  return text(focus_) + " over " + text(before_) +
         (person_ ? "" : ", margin " + two_digits(options_.margin));
}

std::vector<Standing> Workspace::standings(hc::MonotonicTime now) const {
  std::vector<Standing> result;
  for (const auto& [mode, bid] : bids_)
    if (!person_ || person_->first != mode)
      result.push_back({mode, bid.salience, now - bid.made, mode == focus_, false});
  if (person_) {
    const auto& [mode, bid] = *person_;
    auto place = std::find_if(result.begin(), result.end(),
                              [&, number = mode](const auto& row) { return row.mode > number; });
    result.insert(place, {mode, bid.salience, now - bid.made, mode == focus_, true});
  }
  return result;
}
