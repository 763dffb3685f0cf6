// SPDX-License-Identifier: Apache-2.0
#pragma once
// Which messages of several inputs belong together: those of equal times.
// Pure: no I/O, no clock, no threads; the same messages in the same order give the same sets.

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <span>
#include <vector>

#include <hc/mtp/message.h>

namespace hc {

/// Puts messages of several inputs into sets, one of each input, all of one time.
///
///     Matcher matcher(2, [](std::span<const Message> set) { use(set); });
///     matcher.push(0, left);
///     matcher.push(1, right);
///     matcher.end(0);  // no more of these
///
/// A set is given as soon as it is complete, which takes for granted that the times of an input do
/// not fall: what is older than the set is dropped. A message without a time (0) fits any others:
/// it is taken in its turn, with the next set. Where the time of an input falls, its writer has
/// restarted: what waits at any input is dropped, and matching starts over with that message.
class Matcher {
 public:
  using Take = std::function<void(std::span<const Message>)>;

  /// Most messages of an input that wait for their partners: half of what a reader of shared
  /// memory may hold with two inputs.
  static constexpr std::size_t kMaxWaiting = 16;
  /// At most so many bytes of elements wait at an input, or one message.
  static constexpr std::uint64_t kMaxWaitingBytes = std::uint64_t{256} << 20;

  /// Messages of an input that came into no set.
  struct Dropped {
    std::uint64_t unmatched = 0;  ///< another input had none of this time
    std::uint64_t crowded = 0;    ///< too many waited, and the oldest was dropped
    [[nodiscard]] std::uint64_t total() const { return unmatched + crowded; }
  };

  /// @param inputs  2 or more.
  /// @param take  is called with each set, in the order of inputs, from push(). What it throws goes
  /// to the caller; the set counts as taken.
  Matcher(std::size_t inputs, Take take);

  /// The next message of an input that has not ended. Its elements are to be safe to hold: see
  /// Message::keep(). Cost: in proportion to the messages that are settled by it.
  void push(std::size_t input, Message message);

  /// No more messages of an input come. Again is as once.
  void end(std::size_t input);
  /// After all, they do.
  void begin(std::size_t input) { inputs_[input].ended = false; }

  /// Whether no set can come any more: an input has ended, and all its messages are settled.
  [[nodiscard]] bool done() const;

  /// Whether the next message of an input might push one out.
  [[nodiscard]] bool crowded(std::size_t input) const {
    return inputs_[input].waiting.size() >= kMaxWaiting;
  }

  [[nodiscard]] const Dropped& dropped(std::size_t input) const { return inputs_[input].dropped; }

 private:
  struct Input {
    std::deque<Message> waiting;
    std::int64_t latest = 0;  // time; an earlier one has fallen
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
