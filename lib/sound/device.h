// SPDX-License-Identifier: Apache-2.0
#pragma once
// Shared by playing and recording with SDL2: SDL's audio, restarted for each device to find a
// restarted sound server. SDL_AUDIODRIVER selects the driver (pulseaudio, alsa, disk, dummy, …).

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include <hc/base/clock.h>
#include <hc/base/result.h>
#include <sound/format.h>

namespace hc::audio {

/// Holds SDL's audio. One at a time per process.
using AudioSystem = std::shared_ptr<void>;
/// Errors: System (no sound system).
Result<AudioSystem> start_audio();

/// Computes the time of the first frame of each piece of sound by counting frames; restarts if
/// count and clock differ by more than 50 ms. Pure.
class FrameClock {
 public:
  explicit FrameClock(int rate) : rate_(rate) {}
  /// @param frames  in this piece.
  /// @param now  time of its last frame.
  /// @returns  time of its first frame.
  Time stamp(std::int64_t frames, Time now);

 private:
  int rate_;
  std::optional<Time> start_;
  std::int64_t counted_ = 0;
};

}  // namespace hc::audio
