// SPDX-License-Identifier: Apache-2.0
#pragma once
// Which of several sources is obeyed where only one can be: a stick, a command, a tracker. Pure.

#include <chrono>
#include <optional>

#include <hc/base/clock.h>

namespace hc {

/// Lets one source have the turn: the first that asks keeps it until it lets go or is silent, and
/// all others wait. Two sources that contradict each other therefore never alternate.
///
///     if (!turn.take(message.header.src, now)) return;  // another stick is pushed
///     steer(message);
///     if (is_in_its_middle(message)) turn.release(message.header.src);
template <typename Source>
class Turn {
 public:
  /// @param silence  a source that has not asked for longer than this has lost its turn.
  explicit Turn(std::chrono::nanoseconds silence) : silence_(silence) {}

  /// Whether `source` has the turn now; it takes it where nobody has.
  bool take(const Source& source, MonotonicTime now) {
    if (const auto* other = holder(now); other != nullptr && *other != source) return false;
    holder_ = source;
    heard_ = now;
    return true;
  }
  /// Ends the turn of `source`; without effect if another has it.
  void release(const Source& source) {
    if (holder_ == source) holder_.reset();
  }
  /// Who has the turn; null: nobody.
  [[nodiscard]] const Source* holder(MonotonicTime now) const {
    return holder_ && now - heard_ <= silence_ ? &*holder_ : nullptr;
  }

 private:
  std::chrono::nanoseconds silence_;
  std::optional<Source> holder_;
  MonotonicTime heard_{};
};

}  // namespace hc
