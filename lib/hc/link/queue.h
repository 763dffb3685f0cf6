// SPDX-License-Identifier: Apache-2.0
#pragma once
// Messages that wait to go onto a link, bounded in number and memory, at the pace of its policy.
// Internal. Pure: time is passed in.

#include <algorithm>
#include <cstdint>
#include <deque>
#include <optional>
#include <utility>

#include <hc/link/link.h>
#include <hc/link/policy.h>

namespace hc::internal {

/// A queue of whole messages none of which has begun to go. When there are more than the policy
/// keeps, or they take more memory, the oldest are dropped and counted by the reason for which they
/// had not been sent yet; the newest one always stays, however large.
template <typename Item>
class SendQueue {
 public:
  explicit SendQueue(const Policy& policy)
      : keep_(policy.keep), memory_(policy.memory), pace_(policy.rate, policy.burst) {}

  [[nodiscard]] bool empty() const { return items_.empty(); }
  [[nodiscard]] std::size_t messages() const { return messages_; }
  [[nodiscard]] std::uint64_t bytes() const { return bytes_; }
  [[nodiscard]] const Item& front() const { return items_.front().item; }
  [[nodiscard]] Item& back() { return items_.back().item; }

  /// Whether there is memory for one more; always for the first.
  [[nodiscard]] bool has_memory(std::uint64_t bytes) const {
    return items_.empty() || bytes_ + bytes <= memory_;
  }

  /// Adds a message, and drops what there is no room for; nothing where all are kept.
  void push(Item item, std::uint64_t bytes, Traffic& traffic) {
    // What is behind a message that is kept back is kept back too.
    bool held = !items_.empty() && items_.front().held;
    items_.push_back({std::move(item), bytes, 1, false});
    bytes_ += bytes;
    ++messages_;
    if (held) hold(items_.back(), traffic);
    if (keep_ == Policy::kAll) return;
    while (items_.size() > 1 && bytes_ > memory_) drop(traffic, traffic.dropped_memory);
    while (items_.size() > keep_)
      drop(traffic, items_.front().held ? traffic.throttled : traffic.dropped_newer);
  }

  /// Says that another message has been made part of the last one, where none is dropped or paced.
  void grow_last(std::uint64_t bytes) {
    ++items_.back().messages;
    ++messages_;
    items_.back().bytes += bytes;
    bytes_ += bytes;
  }

  /// When the first message may go: `now` or later; for ever later where there is none.
  TimePoint ready_at(TimePoint now, Traffic& traffic) {
    if (items_.empty()) return TimePoint::max();
    auto ready = pace_.ready_at(now);
    if (ready > now) hold(items_.front(), traffic);
    return ready;
  }

  /// Takes the first message, which is ready.
  Item pop(TimePoint now) {
    pace_.take(now);
    return remove_front();
  }

  /// Whether a message that comes now may pass the queue by, which is empty: counts it if so.
  bool pass(TimePoint now) {
    if (!items_.empty()) return false;
    if (!pace_.limited()) return true;
    if (pace_.ready_at(now) > now) return false;
    pace_.take(now);
    return true;
  }

  /// Takes the last message back, which has not been sent.
  void take_back() {
    bytes_ -= items_.back().bytes;
    messages_ -= items_.back().messages;
    items_.pop_back();
  }

  /// Drops all, and takes their bytes off; gives their number.
  std::size_t clear(Traffic& traffic) {
    traffic.bytes -= std::exchange(bytes_, 0);
    items_.clear();
    return std::exchange(messages_, 0);
  }

 private:
  struct Entry {
    Item item;
    std::uint64_t bytes;
    std::size_t messages;
    bool held;  // back by the pace
  };

  static void hold(Entry& entry, Traffic& traffic) {
    if (!std::exchange(entry.held, true)) ++traffic.delayed;
  }

  /// What is dropped was counted when it was put in, but never sent: its bytes are taken off.
  void drop(Traffic& traffic, std::uint64_t& counter) {
    ++counter;
    traffic.bytes -= items_.front().bytes;
    remove_front();
  }

  Item remove_front() {
    Item item = std::move(items_.front().item);
    bytes_ -= items_.front().bytes;
    messages_ -= items_.front().messages;
    items_.pop_front();
    return item;
  }

  std::size_t keep_;
  std::uint64_t memory_;
  std::uint64_t bytes_ = 0;
  std::size_t messages_ = 0;
  TokenBucket pace_;
  std::deque<Entry> items_;
};

}  // namespace hc::internal
