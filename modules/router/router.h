// SPDX-License-Identifier: Apache-2.0
#pragma once
// Decides whether a router forwards a message: decrements its ttl and drops duplicates. Pure: times
// come from the caller and never go back.

#include <cstdint>
#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

#include <hc/base/clock.h>
#include <hc/mtp/header.h>

/// Remembers recent messages, to recognise duplicates that return through a loop.
///
/// Messages are equal if src, dst, seq and time are. A message is remembered for a time, unless its
/// source has sent `max_of_source` others since. A new message is never taken for a duplicate; a
/// duplicate of a forgotten message passes again, until its ttl is used up.
///
/// Memory: 32 to 64 bytes per remembered message, at most `max` messages. If full, the source that
/// has been silent longest is forgotten.
class SeenBefore {
 public:
  explicit SeenBefore(std::chrono::nanoseconds remember, std::size_t max_of_source = 1 << 16,
                      std::size_t max = 1 << 20)
      : remember_(remember), max_of_source_(max_of_source), max_(max) {}

  /// Whether the message was seen before; remembers it. Cost: amortised constant.
  bool insert(const hc::Header& header, hc::MonotonicTime now);

  /// Allocated entries.
  [[nodiscard]] std::size_t room() const { return room_; }

 private:
  struct Entry {
    std::int64_t seq = -1;
    hc::Time time;
    hc::MonotonicTime came{};
    std::int32_t dst = 0;
  };
  /// The messages of one source: a set-associative table with kWays entries per set, indexed by seq
  /// modulo the number of sets. So consecutive seq never evict each other.
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

/// Messages passed and dropped.
struct RouterCounts {
  std::int64_t passed = 0;
  std::int64_t ttl = 0;         ///< dropped: ttl used up (R42)
  std::int64_t seen = 0;        ///< dropped: duplicate
  std::int64_t no_route = 0;    ///< dropped: no link for its dst
  std::int64_t no_address = 0;  ///< dropped: dst 0, and no link for those

  [[nodiscard]] std::int64_t total() const { return passed + ttl + seen + no_route + no_address; }
  /// "3 passed; dropped: 1 ttl, 0 seen before, 0 without a route, 0 without an address"
  [[nodiscard]] std::string text() const;
};

/// Filters messages and counts them.
class Router {
 public:
  explicit Router(std::chrono::nanoseconds remember) : seen_(remember) {}

  /// Whether to forward the message. If so, its ttl has been decremented, and sent() must follow.
  bool admit(hc::Header& header, hc::MonotonicTime now);
  /// Counts a message by the number of links it was sent to.
  void sent(const hc::Header& header, std::size_t links);

  [[nodiscard]] const RouterCounts& counts() const { return counts_; }

 private:
  SeenBefore seen_;
  RouterCounts counts_;
};
