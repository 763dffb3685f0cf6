// SPDX-License-Identifier: Apache-2.0
#pragma once
// Which messages of several inputs belong together, by the times at which they were sensed.
// Pure: no I/O, no clock, no threads; the same messages in the same order give the same sets.

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <limits>
#include <span>
#include <vector>

#include <hc/mtp/message.h>

namespace hc {

/// How messages are taken together.
struct Matching {
  /// Largest difference of times in a set; 0: all are equal.
  std::chrono::nanoseconds within{0};
  /// Most messages of an input that wait for their partners, 1 … 32: half of what a reader of
  /// shared memory may hold.
  std::size_t max_waiting = 16;
};

/// Puts messages of several inputs into sets, one of each input.
///
///     Matcher matcher(2, {.within = 10ms}, [](std::span<const Message> set) { use(set); });
///     matcher.push(0, left);
///     matcher.push(1, right);
///     matcher.end(0);  // no more of these
///
/// The *spread* of a set is the difference of its latest and its earliest time. Of all sets, the
/// one with the smallest spread is taken, the earliest of several; then the same is done with what
/// is before it at every input, and with what is behind it. So a message is in one set at most,
/// sets follow one another as their messages do, none spreads over more than `within`, and where
/// one was not taken, a closer one has one of its messages or stands in its way.
///
/// A set is given as soon as this is certain, which takes for granted that the times of an input
/// do not fall: where all times are equal that is at once, else when the inputs have come so far
/// that no closer one can follow. A message without a time (0) fits any others: it is taken in its
/// turn, with the first set of the others.
///
/// Where the time of an input falls, its writer has started anew: what waits at any input is
/// settled as at the end, and matching begins anew with that message.
class Matcher {
 public:
  using Take = std::function<void(std::span<const Message>)>;

  /// At most so many bytes of elements wait at an input, or one message.
  static constexpr std::uint64_t kMostWaitingBytes = std::uint64_t{256} << 20;

  /// Messages of an input that came into no set.
  struct LeftOut {
    std::uint64_t unmatched = 0;  ///< no partners were near enough, or others were nearer to them
    std::uint64_t crowded = 0;    ///< too many waited: the oldest made room
    [[nodiscard]] std::uint64_t total() const { return unmatched + crowded; }
  };

  /// @param take  is called with each set, in the order of inputs, from push() and end(). What it
  /// throws goes to their caller; the set counts as taken.
  Matcher(std::size_t inputs, const Matching& how, Take take);

  /// The next message of an input. Its elements are to be safe to hold: see Message::keep().
  /// Cost: in proportion to the messages that wait.
  void push(std::size_t input, Message message);

  /// No more messages of an input come. Again is as once.
  void end(std::size_t input);
  /// After all, they do.
  void begin(std::size_t input) { inputs_[input].ended = false; }

  /// Whether no set can come any more: an input has ended, and all its messages are settled.
  [[nodiscard]] bool done() const;

  /// Whether the next message of an input might push one out.
  [[nodiscard]] bool crowded(std::size_t input) const {
    return inputs_[input].waiting.size() >= how_.max_waiting;
  }

  [[nodiscard]] const LeftOut& left_out(std::size_t input) const { return inputs_[input].left_out; }

 private:
  static constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

  struct Input {
    std::deque<Message> waiting;
    std::int64_t latest = 0;  // time; one that is earlier has fallen
    bool ended = false;
    LeftOut left_out;
  };

  /// For a message, the closest set in which it is the earliest.
  struct Candidate {
    std::vector<std::size_t> at;   // which of the messages that wait; their number: one to come
    std::size_t earliest = kNone;  // input
    std::int64_t spread = 0;       // at least, where some are still to come [ns]
    bool complete = true;          // none is still to come
  };
  using Candidates = std::vector<Candidate>;

  [[nodiscard]] Candidate candidate(const std::vector<std::size_t>& at) const;
  [[nodiscard]] Candidates candidates(bool closed) const;
  [[nodiscard]] const Candidate* choose(const Candidates& candidates) const;
  void settle(bool closed);
  void take(const Candidate& chosen);
  static void leave_out(Input& input, std::uint64_t LeftOut::*reason);

  std::vector<Input> inputs_;
  Matching how_;
  Take take_;
};

}  // namespace hc
