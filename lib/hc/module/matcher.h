// SPDX-License-Identifier: Apache-2.0
#pragma once
// Matches messages of several inputs by their times.
// Pure: no I/O, no clock, no threads; the same messages in the same order give the same sets.

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <span>
#include <vector>

#include <hc/mtp/message.h>

namespace hc {

/// Makes sets of messages, one of each input, all of the same time.
///
///     Matcher matcher(2, [](std::span<const Message> set) { use(set); });
///     matcher.push(0, left);
///     matcher.push(1, right);
///     matcher.end(0);  // no more of these
///
/// A set is passed on as soon as it is complete, and older messages are dropped, since the times of
/// an input normally never decrease. If they do, the writer has restarted: all waiting messages are
/// dropped, and matching starts again with that message. A message without a time matches any
/// others: it is part of the next set.
class Matcher {
 public:
  using Take = std::function<void(std::span<const Message>)>;

  /// Maximum number of messages that wait at an input, of the 63 that a reader of shared memory may
  /// hold.
  static constexpr std::size_t kMaxWaiting = 16;
  /// Maximum number of bytes of their elements; one message may always wait.
  static constexpr std::uint64_t kMaxWaitingBytes = std::uint64_t{256} << 20;

  /// Messages of an input that are part of no set.
  struct Dropped {
    std::uint64_t unmatched = 0;  ///< another input had none of that time
    std::uint64_t crowded = 0;    ///< the oldest of too many
    [[nodiscard]] std::uint64_t total() const { return unmatched + crowded; }
  };

  /// @param inputs  2 or more.
  /// @param take  called from push() with each set, in the order of inputs. Its exceptions reach
  /// the
  ///   caller of push(); the set counts as taken.
  Matcher(std::size_t inputs, Take take);

  /// Adds the next message of an input that has not ended; its elements must be safe to hold (see
  /// Message::keep()). Cost: linear in the messages that are matched or dropped.
  void push(std::size_t input, Message message);

  /// Ends an input; no effect if it has ended.
  void end(std::size_t input);
  /// Reopens an input that has ended.
  void begin(std::size_t input) { inputs_[input].ended = false; }

  /// Whether no further set is possible: an input has ended, and none of its messages waits.
  [[nodiscard]] bool done() const;

  /// Whether the next message of an input may displace its oldest one.
  [[nodiscard]] bool crowded(std::size_t input) const {
    return inputs_[input].waiting.size() >= kMaxWaiting;
  }

  /// Whether all inputs have had messages for kStarving, by their times, without a set.
  [[nodiscard]] bool is_starving() const;
  static constexpr std::chrono::seconds kStarving{3};

  [[nodiscard]] const Dropped& dropped(std::size_t input) const { return inputs_[input].dropped; }

 private:
  struct Input {
    std::deque<Message> waiting;
    Time latest;
    std::size_t since_set = 0;  ///< messages with a time
    Time first_since_set;
    bool ended = false;
    Dropped dropped;
  };

  [[nodiscard]] bool is_complete() const;
  void settle();
  void take();
  void drop_waiting();

  std::vector<Input> inputs_;
  Take take_;
};

}  // namespace hc
