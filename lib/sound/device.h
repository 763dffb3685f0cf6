// SPDX-License-Identifier: Apache-2.0
#pragma once
// What playing and recording by SDL2 share: SDL's audio, restarted for each device, so that a
// restarted sound server is found; and when to try again. Which driver is used says
// SDL_AUDIODRIVER (pulseaudio, alsa, disk, dummy, …).

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

/// SDL's audio while it is held. One at a time in a process.
using AudioSystem = std::shared_ptr<void>;
/// Errors: System (there is no sound here).
Result<AudioSystem> start_audio();

/// Gives sound that comes in pieces the time of its first frame: counts frames, and starts over
/// where the count and the clock differ by more than 50 ms. Pure.
class FrameClock {
 public:
  explicit FrameClock(int rate) : rate_(rate) {}
  /// @param frames  in this piece.
  /// @param now  when its last frame was there. [ns since the Unix epoch]
  /// @returns  when its first frame was. [ns since the Unix epoch]
  std::int64_t stamp(std::int64_t frames, std::int64_t now);

 private:
  int rate_;
  std::optional<std::int64_t> start_;
  std::int64_t counted_ = 0;
};

}  // namespace hc::audio
