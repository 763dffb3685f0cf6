// SPDX-License-Identifier: Apache-2.0
#pragma once
// A loudspeaker, by SDL2.

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include <hc/base/result.h>
#include <sound/device.h>
#include <sound/format.h>

namespace hc::audio {

/// Plays what it is given, one after the other, and silence between. For one thread.
class Playback {
 public:
  /// @param device  its name as SDL gives it; "" the default one.
  ///
  /// Errors: System (no such device, no sound here).
  static Result<std::unique_ptr<Playback>> open(const std::string& device, const Format& format);
  Playback(const Playback&) = delete;
  Playback& operator=(const Playback&) = delete;
  /// Plays no more than what the device has already.
  ~Playback();

  /// Takes samples, channels next to one another. Never waits: who looks at waiting()
  /// before keeps the queue short.
  void put(std::span<const std::int16_t> samples);
  /// Frames that have not been sent to the device yet.
  [[nodiscard]] std::int64_t waiting() const;
  /// False once the device is disconnected; nothing is played any more then.
  [[nodiscard]] bool is_there() const;
  [[nodiscard]] const Format& format() const { return format_; }

 private:
  Playback(AudioSystem system, std::uint32_t device, const Format& format)
      : system_(std::move(system)), device_(device), format_(format) {}

  AudioSystem system_;
  std::uint32_t device_;
  Format format_;
};

}  // namespace hc::audio
