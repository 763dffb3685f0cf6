// SPDX-License-Identifier: Apache-2.0
#pragma once
// A queue of messages to be sent, bounded in number and memory, at a limited pace. Internal.
// Pure: time is passed in.

#include <algorithm>
#include <cstdint>
#include <deque>
#include <optional>
#include <utility>

#include <hc/link/link.h>
#include <hc/link/policy.h>

namespace hc::internal {

/// A queue of messages of which none has been sent partly. If it exceeds the policy's number or
/// memory, the oldest messages are dropped and counted by the reason why they were still queued;
/// the newest always stays, however large.
template <typename Item>
class SendQueue {
 public:
  explicit SendQueue(const Policy& policy)
      : keep_(policy.keep), memory_(policy.memory), pace_(policy) {}

  [[nodiscard]] bool empty() const { return items_.empty(); }
  [[nodiscard]] std::size_t messages() const { return messages_; }
  [[nodiscard]] std::uint64_t bytes() const { return bytes_; }
  [[nodiscard]] const Item& front() const { return items_.front().item; }
  [[nodiscard]] Item& back() { return items_.back().item; }

  /// Whether there is memory for another message; always true for the first.
  [[nodiscard]] bool has_memory(std::uint64_t bytes) const {
    return items_.empty() || bytes_ + bytes <= memory_;
  }

  /// Adds a message and drops the excess, unless all are kept.
  void push(Item item, std::uint64_t bytes, Traffic& traffic) {
    // If the first message is delayed by the pace, so are all after it.
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

  /// Adds a message to the last item. Only for policies without limits.
  void grow_last(std::uint64_t bytes) {
    ++items_.back().messages;
    ++messages_;
    items_.back().bytes += bytes;
    bytes_ += bytes;
  }

  /// When the first message may be sent: `now` or later; TimePoint::max() if the queue is empty.
  TimePoint ready_at(TimePoint now, Traffic& traffic) {
    if (items_.empty()) return TimePoint::max();
    auto ready = pace_.ready_at(now, items_.front().bytes);
    if (ready > now) hold(items_.front(), traffic);
    return ready;
  }

  /// Removes the first message, which must be ready.
  Item pop(TimePoint now) {
    pace_.take(now, items_.front().bytes);
    return remove_front();
  }

  /// Whether a new message may bypass the queue, which must be empty; takes its tokens if so.
  bool pass(TimePoint now, std::uint64_t bytes) {
    if (!items_.empty()) return false;
    if (!pace_.limited()) return true;
    if (pace_.ready_at(now, bytes) > now) return false;
    pace_.take(now, bytes);
    return true;
  }

  /// Removes the last message, which has not been sent.
  void take_back() {
    bytes_ -= items_.back().bytes;
    messages_ -= items_.back().messages;
    items_.pop_back();
  }

  /// Drops all messages and subtracts their bytes; returns their number.
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
    bool held;  // delayed by the pace
  };

  static void hold(Entry& entry, Traffic& traffic) {
    if (!std::exchange(entry.held, true)) ++traffic.delayed;
  }

  /// Dropped messages were counted when they were queued; subtracts their bytes, which were not
  /// sent.
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
  Pace pace_;
  std::deque<Entry> items_;
};

}  // namespace hc::internal
