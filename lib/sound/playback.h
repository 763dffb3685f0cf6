// SPDX-License-Identifier: Apache-2.0
#pragma once
// A loudspeaker, with SDL2.

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include <hc/base/result.h>
#include <sound/device.h>
#include <sound/format.h>

namespace hc::audio {

/// Plays consecutive sounds, with silence when there is none. For one thread.
class Playback {
 public:
  /// @param device  SDL's name; "": the default.
  ///
  /// Errors: System (no such device, no sound system).
  static Result<std::unique_ptr<Playback>> open(const std::string& device, const Format& format);
  Playback(const Playback&) = delete;
  Playback& operator=(const Playback&) = delete;
  /// Drops the queue; the device plays only the frames it already has.
  ~Playback();

  /// Queues samples, interleaved channels. Never blocks: check waiting() to keep the queue short.
  void put(std::span<const std::int16_t> samples);
  /// Frames not yet sent to the device.
  [[nodiscard]] std::int64_t waiting() const;
  /// False once the device is disconnected; then nothing is played.
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
