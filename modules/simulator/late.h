// SPDX-License-Identifier: Apache-2.0
#pragma once
// What is ready now and given later: a queue with a time for each. Pure.

#include <cstdint>
#include <deque>
#include <optional>
#include <utility>

template <typename T>
class Late {
 public:
  /// @param due  when it is to be given; it waits for all that was put before it, too [ns].
  void put(std::int64_t due, T thing) { waiting_.emplace_back(due, std::move(thing)); }

  /// The first, once it is due; one at a time.
  std::optional<T> take(std::int64_t now) {
    if (waiting_.empty() || waiting_.front().first > now) return std::nullopt;
    std::optional<T> first(std::move(waiting_.front().second));
    waiting_.pop_front();
    return first;
  }

  [[nodiscard]] bool empty() const { return waiting_.empty(); }

 private:
  std::deque<std::pair<std::int64_t, T>> waiting_;
};
