// SPDX-License-Identifier: Apache-2.0
#pragma once
// The modes in which a module works, and which mode is in focus. Pure. Internal.

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <vector>

#include <hc/base/clock.h>
#include <hc/contract/stops.h>

namespace hc::internal {

/// How long a message of the focus is valid. The workspace repeats it six times as often. If it
/// hangs or dies, exclusive inputs accept nothing until it is back.
constexpr std::chrono::milliseconds kFocusExpiry{120};

/// Modes are numbers from 1 on; 0 is none.
struct Focus {
  std::vector<std::int32_t> modes;  ///< in which the module works; empty: in all
  std::int32_t own = 0;             ///< mode of all messages of a task; 0: not a task
  std::int32_t current = 0;         ///< mode in focus, as last received; 0: none, or expired
  MonotonicTime received{0};        ///< when `current` was
  std::int32_t decided = 0;         ///< by this module, if it is the arbiter; 0: none
  Stops stops;                      ///< the sources that stop this arbiter
  bool is_linked = false;           ///< to a workspace

  [[nodiscard]] bool in_focus() const {
    return modes.empty() || std::find(modes.begin(), modes.end(), current) != modes.end();
  }
  /// Whether an input accepts a message of a mode: an exclusive one only if it is in focus.
  [[nodiscard]] bool admits(bool is_exclusive, std::int32_t mode) const {
    return !is_exclusive || (mode != 0 && mode == current);
  }
  /// Whether exclusive inputs accept messages of this module, as far as it knows.
  [[nodiscard]] bool has_own_focus() const { return !is_linked || own == 0 || admits(true, own); }
  /// Forgets a focus that was not repeated in time. Returns whether it did.
  bool expire(MonotonicTime now) {
    if (current == 0 || now - received <= kFocusExpiry) return false;
    current = 0;
    return true;
  }
  /// The mode of a message. @param handled  mode of the message that is being handled; 0: none.
  [[nodiscard]] std::int32_t mode_of(std::int32_t handled) const {
    if (own != 0) return own;
    return handled != 0 ? handled : current;
  }
};

}  // namespace hc::internal
