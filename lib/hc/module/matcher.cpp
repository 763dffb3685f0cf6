// SPDX-License-Identifier: Apache-2.0
#include <hc/module/matcher.h>

#include <algorithm>
#include <numeric>

namespace hc {
namespace {

std::uint64_t bytes_of(const std::deque<Message>& messages) {
  return std::accumulate(
      messages.begin(), messages.end(), std::uint64_t{0},
      [](std::uint64_t sum, const Message& message) { return sum + message.elements.size(); });
}

}  // namespace

Matcher::Matcher(std::size_t inputs, const Matching& how, Take take)
    : inputs_(inputs), how_(how), take_(std::move(take)) {
  HC_CHECK(inputs >= 2, inputs);
  HC_CHECK(how.within.count() >= 0, how.within.count());
  HC_CHECK(how.max_waiting >= 1 && how.max_waiting <= 32, how.max_waiting);
}

void Matcher::push(std::size_t input, Message message) {
  auto& [waiting, latest, ended, left_out] = inputs_[input];
  HC_CHECK(!ended, input);
  const std::int64_t time = message.header.time;
  if (time != 0 && time < latest) {
    settle(true);
    for (auto& each : inputs_) each.latest = 0;
  }
  if (time != 0) latest = time;
  waiting.push_back(std::move(message));
  settle(false);
  while (waiting.size() > how_.max_waiting ||
         (waiting.size() > 1 && bytes_of(waiting) > kMostWaitingBytes)) {
    leave_out(inputs_[input], &LeftOut::crowded);
    settle(false);
  }
}

void Matcher::end(std::size_t input) {
  inputs_[input].ended = true;
  settle(false);
}

bool Matcher::done() const {
  return std::any_of(inputs_.begin(), inputs_.end(),
                     [](const Input& input) { return input.ended && input.waiting.empty(); });
}

Matcher::Candidate Matcher::candidate(const std::vector<std::size_t>& at) const {
  Candidate found{at};
  std::int64_t first = 0, last = 0;
  for (std::size_t i = 0; i < inputs_.size(); ++i) {
    const auto& waiting = inputs_[i].waiting;
    if (at[i] == waiting.size()) {
      // At best its time will be between those of the others.
      found.complete = false;
    } else if (const std::int64_t time = waiting[at[i]].header.time; time != 0) {
      if (found.earliest == kNone || time < first) {
        found.earliest = i;
        first = time;
      }
      last = std::max(last, time);
    }
  }
  if (found.earliest != kNone) found.spread = last - first;
  return found;
}

/// All candidates, by their earliest message. Each has the messages of the one before, but for the
/// earliest, which makes place for the next of its input: nothing else could bring a set closer.
Matcher::Candidates Matcher::candidates(bool closed) const {
  Candidates all;
  std::vector<std::size_t> at(inputs_.size(), 0);
  auto runs_out = [&](std::size_t i) {
    return at[i] == inputs_[i].waiting.size() && (closed || inputs_[i].ended);
  };
  for (std::size_t i = 0; i < inputs_.size(); ++i)
    if (runs_out(i)) return all;
  while (true) {
    all.push_back(candidate(at));
    const std::size_t earliest = all.back().earliest;
    if (earliest == kNone) return all;
    ++at[earliest];
    if (runs_out(earliest)) return all;
  }
}

/// The set that comes next for certain, null when that is not to be told yet.
const Matcher::Candidate* Matcher::choose(const Candidates& candidates) const {
  auto closest = [](auto from, auto to) {
    return std::min_element(
        from, to, [](const Candidate& a, const Candidate& b) { return a.spread < b.spread; });
  };
  // A message without a time binds nobody: it goes with the first.
  auto share = [&](const Candidate& a, const Candidate& b) {
    for (std::size_t i = 0; i < inputs_.size(); ++i)
      if (a.at[i] == b.at[i] && inputs_[i].waiting[a.at[i]].header.time != 0) return true;
    return false;
  };
  // Those that share a message with one stand next to it. A closer one behind it takes its place.
  auto chosen = candidates.begin();
  for (auto best = chosen;; chosen = best) {
    best = closest(chosen, std::find_if_not(chosen, candidates.end(), [&](const Candidate& each) {
                     return share(*chosen, each);
                   }));
    if (!best->complete) return nullptr;
    if (best == chosen) break;
  }
  // What is before a set that is certain is settled by itself.
  while (true) {
    auto before = std::find_if(candidates.begin(), chosen,
                               [&](const Candidate& each) { return share(*chosen, each); });
    auto best = closest(candidates.begin(), before);
    if (best == before || best->spread > how_.within.count()) return &*chosen;
    chosen = best;
  }
}

void Matcher::settle(bool closed) {
  while (true) {
    const Candidates all = candidates(closed);
    if (all.empty()) break;
    const Candidate& first = all.front();
    if (first.earliest == kNone && !first.complete) return;
    if (first.spread > how_.within.count()) {
      leave_out(inputs_[first.earliest], &LeftOut::unmatched);
    } else if (const Candidate* chosen = choose(all); chosen != nullptr) {
      take(*chosen);
    } else {
      return;
    }
  }
  // An input has no message left, and none to come.
  for (auto& input : inputs_)
    while (!input.waiting.empty()) leave_out(input, &LeftOut::unmatched);
}

void Matcher::take(const Candidate& chosen) {
  std::vector<Message> set;
  for (std::size_t i = 0; i < inputs_.size(); ++i) {
    for (std::size_t before = 0; before < chosen.at[i]; ++before)
      leave_out(inputs_[i], &LeftOut::unmatched);
    set.push_back(std::move(inputs_[i].waiting.front()));
    inputs_[i].waiting.pop_front();
  }
  take_(set);
}

void Matcher::leave_out(Input& input, std::uint64_t LeftOut::*reason) {
  input.waiting.pop_front();
  ++(input.left_out.*reason);
}

}  // namespace hc
