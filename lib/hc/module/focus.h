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

/// How long a message of the focus counts. The workspace repeats it six times as often, so when it
/// hangs or dies, exclusive inputs take nothing until it is back.
constexpr std::chrono::milliseconds kFocusExpiry{120};

/// Modes are numbers from 1 on; 0 is none.
struct Focus {
  std::vector<std::int32_t> modes;  ///< in which the module works; empty: in all
  std::int32_t own = 0;             ///< mode of all its messages, where it is a task
  std::int32_t current = 0;   ///< mode in focus, as last received; 0: none, or that has expired
  MonotonicTime received{0};  ///< when `current` was
  std::int32_t decided = 0;   ///< of who decides on the focus: which has it
  Stops stops;                ///< of who decides on the focus: who holds it back
  bool is_linked = false;     ///< whether there is a link from a workspace

  [[nodiscard]] bool in_focus() const {
    return modes.empty() || std::find(modes.begin(), modes.end(), current) != modes.end();
  }
  /// Whether an input takes a message of a mode: an exclusive one only of the mode in focus, and
  /// none while no mode has the focus.
  [[nodiscard]] bool admits(bool is_exclusive, std::int32_t mode) const {
    return !is_exclusive || (mode != 0 && mode == current);
  }
  /// Whether an exclusive input takes what the module sends of its own mode, as far as it knows.
  [[nodiscard]] bool has_own_focus() const { return !is_linked || own == 0 || admits(true, own); }
  /// Forgets a focus that was not repeated in time; whether it was forgotten now.
  bool expire(MonotonicTime now) {
    if (current == 0 || now - received <= kFocusExpiry) return false;
    current = 0;
    return true;
  }
  /// The mode of a message that is made while one of `handled` mode is handled, or none is (0).
  [[nodiscard]] std::int32_t mode_of(std::int32_t handled) const {
    if (own != 0) return own;
    return handled != 0 ? handled : current;
  }
};

}  // namespace hc::internal
