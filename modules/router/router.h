// SPDX-License-Identifier: Apache-2.0
#pragma once
// What a router does with a message, but for the way on: takes one off its ttl, and lets it pass
// once. Pure: time is handed in and never goes back.

#include <cstdint>
#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

#include <hc/base/clock.h>
#include <hc/mtp/header.h>

/// Messages that came lately, to recognise one that comes again in a circle.
///
/// Two are the same where src, dst, seq and time are. A message is remembered for a time, unless
/// its source has sent `max_of_source` others since. What was not remembered is never taken for
/// the same, so no fresh message is dropped; what was forgotten is let through once more, until its
/// ttl ends it.
///
/// Memory: 32 bytes for each message that is remembered, twice that at most, `max` in all; when
/// there is no more, the source that was silent longest is forgotten.
class SeenBefore {
 public:
  explicit SeenBefore(std::chrono::nanoseconds remember, std::size_t max_of_source = 1 << 16,
                      std::size_t max = 1 << 20)
      : remember_(remember), max_of_source_(max_of_source), max_(max) {}

  /// Whether the message has come before; from now on it has. Cost: constant, but for a window that
  /// grows.
  bool insert(const hc::Header& header, hc::MonotonicTime now);

  /// Messages that there is room for now.
  [[nodiscard]] std::size_t room() const { return room_; }

 private:
  struct Entry {
    std::int64_t seq = -1;
    std::int64_t time = 0;
    hc::MonotonicTime came{};
    std::int32_t dst = 0;
  };
  /// Of one source. A message can be at kWays places behind seq modulo the number of such sets, so
  /// that the newest of a source that counts are all there.
  struct Window {
    std::vector<Entry> entries;
    hc::MonotonicTime latest{};
  };
  static constexpr std::size_t kWays = 4, kMin = 64;

  static Entry* set_of(Window& window, std::int64_t seq);
  Window& window_of(std::int32_t src, hc::MonotonicTime now);
  bool grow(Window& window);
  void forget_silent(const Window* but);

  std::chrono::nanoseconds remember_;
  std::size_t max_of_source_, max_, room_ = 0;
  std::unordered_map<std::int32_t, Window> windows_;
  std::int32_t last_src_ = -1;
  Window* last_ = nullptr;  // of last_src_
};

/// Messages by what became of them.
struct RouterCounts {
  std::int64_t passed = 0;
  std::int64_t ttl = 0;         ///< dropped: it had no router left to pass (R42)
  std::int64_t seen = 0;        ///< dropped: came before
  std::int64_t no_route = 0;    ///< dropped: no link leads to its dst
  std::int64_t no_address = 0;  ///< dropped: dst 0, and no link takes those

  [[nodiscard]] std::int64_t total() const { return passed + ttl + seen + no_route + no_address; }
  /// "3 passed; dropped: 1 ttl, 0 seen before, 0 without a route, 0 without an address"
  [[nodiscard]] std::string text() const;
};

/// Judges messages and counts them.
class Router {
 public:
  explicit Router(std::chrono::nanoseconds remember) : seen_(remember) {}

  /// Whether the message is to be sent on. Then its ttl has been lowered, and sent() must be
  /// called.
  bool admit(hc::Header& header, hc::MonotonicTime now);
  /// How many links have taken the message.
  void sent(const hc::Header& header, std::size_t links);

  [[nodiscard]] const RouterCounts& counts() const { return counts_; }

 private:
  SeenBefore seen_;
  RouterCounts counts_;
};
