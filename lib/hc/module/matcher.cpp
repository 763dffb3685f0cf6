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

Matcher::Matcher(std::size_t inputs, Take take) : inputs_(inputs), take_(std::move(take)) {
  HC_CHECK(inputs >= 2, inputs);
}

void Matcher::push(std::size_t input, Message message) {
  auto& [waiting, latest, since_set, first_since_set, ended, dropped] = inputs_[input];
  HC_CHECK(!ended, input);
  const Time time = message.header.time;
  if (time != Time() && time < latest) {
    drop_waiting();
    for (auto& each : inputs_) {
      each.latest = {};
      each.since_set = 0;
    }
  }
  if (time != Time()) {
    latest = time;
    if (since_set++ == 0) first_since_set = time;
  }
  waiting.push_back(std::move(message));
  settle();
  while (waiting.size() > kMaxWaiting ||
         (waiting.size() > 1 && bytes_of(waiting) > kMaxWaitingBytes)) {
    waiting.pop_front();
    ++dropped.crowded;
  }
}

bool Matcher::is_starving() const {
  return std::all_of(inputs_.begin(), inputs_.end(), [](const Input& input) {
    return input.since_set >= kMaxWaiting && input.latest - input.first_since_set >= kStarving;
  });
}

void Matcher::end(std::size_t input) {
  inputs_[input].ended = true;
  if (done()) drop_waiting();
}

bool Matcher::done() const {
  return std::any_of(inputs_.begin(), inputs_.end(),
                     [](const Input& input) { return input.ended && input.waiting.empty(); });
}

/// Whether a message waits at every input.
bool Matcher::is_complete() const {
  return std::none_of(inputs_.begin(), inputs_.end(),
                      [](const Input& input) { return input.waiting.empty(); });
}

void Matcher::settle() {
  while (is_complete()) {
    Time time;
    for (const auto& input : inputs_) time = std::max(time, input.waiting.front().header.time);
    bool equal = true;
    for (auto& input : inputs_) {
      const Time own = input.waiting.front().header.time;
      if (own == Time() || own == time) continue;
      input.waiting.pop_front();
      ++input.dropped.unmatched;
      equal = false;
    }
    if (equal) take();
  }
  if (done()) drop_waiting();
}

void Matcher::take() {
  std::vector<Message> set;
  set.reserve(inputs_.size());
  for (auto& input : inputs_) {
    set.push_back(std::move(input.waiting.front()));
    input.waiting.pop_front();
    input.since_set = 0;
  }
  take_(set);
}

void Matcher::drop_waiting() {
  for (auto& input : inputs_) {
    input.dropped.unmatched += input.waiting.size();
    input.waiting.clear();
  }
}

}  // namespace hc
