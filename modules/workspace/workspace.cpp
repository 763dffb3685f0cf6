// SPDX-License-Identifier: Apache-2.0
#include "workspace.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <iterator>
#include <string>
#include <tuple>
#include <utility>

namespace {

std::string two_digits(double value) {
  std::array<char, 64> text;
  const auto end =
      std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::fixed, 2).ptr;
  return {text.data(), end};
}

}  // namespace

hc::Status Workspace::check(const Bidder& who, double salience) {
  if (!(salience >= 0 && salience <= 1)) {  // true for NaN, too
    ++refused_.salience;
    return hc::Error{hc::Code::Malformed, "salience " + std::to_string(salience) + " of mode " +
                                              std::to_string(who.mode) + " is not from 0 to 1"};
  }
  if (who.mode <= 0) {
    ++refused_.mode;
    return hc::Error{hc::Code::Malformed,
                     "the mode of a bid must be at least 1, not " + std::to_string(who.mode)};
  }
  if (!names_.empty() && !names_.contains(who.mode)) {
    ++refused_.mode;
    return hc::Error{hc::Code::Malformed, "the graph has no mode " + std::to_string(who.mode)};
  }
  return {};
}

hc::Status Workspace::take(const Bidder& who, double salience, hc::MonotonicTime made,
                           hc::MonotonicTime now, Bids& bids, std::chrono::nanoseconds expiry) {
  HC_TRY(check(who, salience));
  if (now - made >= expiry || made - now > kAhead) {
    ++refused_.time;
    return hc::Error{hc::Code::Malformed, "mode " + std::to_string(who.mode) +
                                              ": the bid has expired or is from the future"};
  }
  const auto known = bids.find(who.mode);
  if (salience == 0) {
    if (known != bids.end() && known->second.erase(who.source) != 0 && known->second.empty())
      bids.erase(known);
    return {};
  }
  const bool is_crowded = known == bids.end() ? bids.size() >= kMostModes
                                              : known->second.size() >= kMostSources &&
                                                    !known->second.contains(who.source);
  if (is_crowded) {
    ++refused_.crowded;
    return hc::Error{hc::Code::TooLarge, "mode " + std::to_string(who.mode) + ": too many bids"};
  }
  made = std::min(made, now);
  const auto [bid, is_new] = bids[who.mode].try_emplace(who.source, Bid{salience, made, now});
  const bool had_expired = now - bid->second.made >= expiry;
  bid->second = {salience, made, is_new || had_expired ? now : bid->second.began};
  return {};
}

const Workspace::Bid& Workspace::greatest(const BidsOfMode& bids) {
  return std::max_element(bids.begin(), bids.end(),
                          [](const auto& a, const auto& b) {
                            return std::tie(a.second.salience, a.second.began) <
                                   std::tie(b.second.salience, b.second.began);
                          })
      ->second;
}

void Workspace::drop_expired(Bids& bids, hc::MonotonicTime now, std::chrono::nanoseconds expiry) {
  for (auto& [mode, of_mode] : bids)
    std::erase_if(of_mode, [&](const auto& bid) { return now - bid.second.made >= expiry; });
  std::erase_if(bids, [](const auto& of_mode) { return of_mode.second.empty(); });
}

/// The mode of the winning person's bid; 0: none.
std::int32_t Workspace::wanted_by_persons() const {
  using Rank = std::tuple<double, bool, hc::MonotonicTime>;
  std::int32_t best = 0;
  std::optional<Rank> greatest_rank;
  for (const auto& [mode, bids] : persons_) {
    const Bid& bid = greatest(bids);
    const Rank rank(bid.salience, mode == focus_, bid.began);
    if (greatest_rank && rank <= *greatest_rank) continue;
    best = mode;
    greatest_rank = rank;
  }
  return best;
}

std::int32_t Workspace::wanted_by_tasks(hc::MonotonicTime now) const {
  auto best = std::max_element(tasks_.begin(), tasks_.end(), [](const auto& a, const auto& b) {
    return greatest(a.second).salience < greatest(b.second).salience;  // the first of equal ones
  });
  if (best == tasks_.end()) return 0;
  auto holder = tasks_.find(focus_);
  if (holder == tasks_.end()) return best->first;
  const bool challenges =
      greatest(best->second).salience > greatest(holder->second).salience + options_.margin;
  return challenges && now - since_ >= options_.dwell ? best->first : focus_;
}

bool Workspace::decide(hc::MonotonicTime now) {
  drop_expired(tasks_, now, options_.expiry);
  drop_expired(persons_, now, options_.person_expiry);
  held_back_ = brake.reason(now);
  const std::int32_t wanted = persons_.empty() ? wanted_by_tasks(now) : wanted_by_persons();
  const std::int32_t next = held_back_.empty() ? wanted : 0;
  if (next == focus_) return false;
  before_ = std::exchange(focus_, next);
  since_ = now;
  return true;
}

std::string Workspace::last_change() const {
  if (focus_ == 0) return "none; " + (held_back_.empty() ? "no bid is left" : held_back_);
  auto text = [&](std::int32_t mode) {
    auto name = names_.find(mode);
    std::string words = name == names_.end() ? "mode " + std::to_string(mode) : name->second;
    if (persons_.contains(mode)) return words + " (a person's bid)";
    auto task = tasks_.find(mode);
    return task == tasks_.end() ? words
                                : words + " (" + two_digits(greatest(task->second).salience) + ")";
  };
  const bool is_contested =
      before_ != 0 && (tasks_.contains(before_) || persons_.contains(before_));
  if (!is_contested) return text(focus_) + (before_ == 0 ? "" : "; no bid of " + text(before_));
  return text(focus_) + " over " + text(before_) +
         (persons_.empty() ? ", margin " + two_digits(options_.margin) : "");
}

std::vector<Standing> Workspace::standings(hc::MonotonicTime now) const {
  std::map<std::int32_t, Standing> rows;
  for (const auto* bids : {&tasks_, &persons_})
    for (const auto& [mode, of_mode] : *bids) {
      const Bid& bid = greatest(of_mode);
      rows[mode] = {mode, bid.salience, now - bid.made, mode == focus_, bids == &persons_};
    }
  std::vector<Standing> result;
  for (const auto& [mode, row] : rows) result.push_back(row);
  return result;
}
