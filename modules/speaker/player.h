// SPDX-License-Identifier: Apache-2.0
#pragma once
// Plays sound on a loudspeaker, which may disconnect at any time, and writes it to a WAV file.

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include <hc/base/backoff.h>
#include <hc/base/clock.h>
#include <hc/base/log.h>
#include <hc/base/result.h>
#include <hc/mtp/message.h>
#include <sound/converter.h>
#include <sound/playback.h>
#include <sound/wav.h>

struct PlayerOptions {
  bool plays = true;   ///< false: only writes the file
  std::string device;  ///< SDL's name; "": the default
  std::string file;    ///< "": none
  int rate = 0;        ///< of the device and the file [Hz]; 0: that of the first sound
  int channels = 0;    ///< of the device and the file; 0: those of the first sound
  double buffer = 1;   ///< queued sound at which play() blocks [s]
};

/// Logs each change of the device once.
class Player {
 public:
  static constexpr std::chrono::seconds kTimeout{1};
  static constexpr std::chrono::milliseconds kLook{100};  ///< period of look()
  /// @param stop  descriptor that becomes readable to end a wait.
  Player(PlayerOptions options, hc::LogSink log, int stop)
      : options_(std::move(options)), log_(std::move(log)), stop_(stop) {}

  /// Plays a sound; blocks while more than `buffer` is queued. If there is no device, or it has
  /// played nothing for kTimeout, the sound is dropped and counted, but still written to the file.
  ///
  /// Errors: Unsupported (format), System.
  template <typename T>
  hc::Status play(std::span<const T> samples, const hc::audio::Format& format);
  /// Plays a message of that format, i16 or f32.
  hc::Status play(const hc::Message& message, const hc::audio::Format& format);

  /// Checks whether the device is connected, and reopens it if not.
  void look();
  /// Plays the rest, and waits until it has been played.
  hc::Status finish();

  /// Messages dropped without a device.
  [[nodiscard]] std::int64_t dropped() const { return dropped_; }
  /// Whether the file could not be written, which has been logged.
  [[nodiscard]] bool has_file_error() const { return file_error_; }

 private:
  hc::Status prepare(hc::audio::Converter::Scalar scalar, const hc::audio::Format& format);
  hc::Status give_out();
  void save(std::span<const std::int16_t> samples);
  void wait_until_at_most(double seconds);
  void look_whether_stuck();

  PlayerOptions options_;
  hc::LogSink log_;
  int stop_;
  std::optional<hc::audio::Format> format_;  // of device and file, once known
  std::optional<hc::audio::Converter> converter_;
  std::optional<hc::audio::WavWriter> writer_;
  bool file_error_ = false;
  std::unique_ptr<hc::audio::Playback> playback_;
  hc::Backoff backoff_;
  bool is_missing_ = false;               // and logged
  std::optional<std::int64_t> stuck_at_;  // frames queued in an unresponsive device
  std::int64_t dropped_ = 0, dropped_logged_ = 0;
};
