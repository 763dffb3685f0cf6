// SPDX-License-Identifier: Apache-2.0
#pragma once
// Decides which of several sources is in control: a joystick, a command, a tracker. Pure.

#include <chrono>
#include <optional>

#include <hc/base/clock.h>

namespace hc {

/// Gives control to one source at a time: the first that asks keeps it until it releases it or is
/// silent. Two sources that contradict each other therefore never alternate.
///
///     if (!turn.take(message.header.src, now)) return;  // another stick is pushed
///     steer(message);
///     if (is_in_its_middle(message)) turn.release(message.header.src);
template <typename Source>
class Turn {
 public:
  /// @param silence  a source that has not asked for longer than this loses its turn.
  explicit Turn(std::chrono::nanoseconds silence) : silence_(silence) {}

  /// Whether `source` has the turn; takes it if it is free.
  bool take(const Source& source, MonotonicTime now) {
    if (const auto* other = holder(now); other != nullptr && *other != source) return false;
    holder_ = source;
    heard_ = now;
    return true;
  }
  /// Ends the turn of `source`; no effect if another has it.
  void release(const Source& source) {
    if (holder_ == source) holder_.reset();
  }
  /// The source that has the turn; null: none.
  [[nodiscard]] const Source* holder(MonotonicTime now) const {
    return holder_ && now - heard_ <= silence_ ? &*holder_ : nullptr;
  }

 private:
  std::chrono::nanoseconds silence_;
  std::optional<Source> holder_;
  MonotonicTime heard_{};
};

}  // namespace hc
