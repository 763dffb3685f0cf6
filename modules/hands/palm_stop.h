// SPDX-License-Identifier: Apache-2.0
#pragma once
// The words to the workspace by which hands stop the robot. Pure: times come from the caller.

#include <chrono>
#include <cstdint>
#include <optional>

#include <hc/base/time.h>
#include <people/sign.h>

/// Stops while any hand holds up a palm, and clears that when a thumb is held up afterwards.
class PalmStop {
 public:
  /// How often a palm that stays up says so again, since a word may be lost. The workspace takes
  /// words that repeat faster for those of a source that guards.
  static constexpr std::chrono::milliseconds kAgain{1000};

  /// Takes the command that one of the hands holds now.
  /// @returns  a word to send: 1 stops, 0 clears.
  std::optional<std::uint8_t> update(hc::MonotonicTime now, hc::people::Sign held) {
    const bool is_said = stopped_ && now - said_ < kAgain;
    if (held == hc::people::Sign::Open) {
      palm_ = now;
      if (is_said) return std::nullopt;
      stopped_ = true;
      said_ = now;
      return 1;
    }
    if (held != hc::people::Sign::ThumbUp || !stopped_ || now - palm_ < kAgain) return std::nullopt;
    stopped_ = false;
    return 0;
  }

 private:
  bool stopped_ = false;
  hc::MonotonicTime said_{}, palm_{};  // the last stop; a palm
};
