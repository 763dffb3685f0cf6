// SPDX-License-Identifier: Apache-2.0
#pragma once
// Where sound goes: a loudspeaker, which may be disconnected at any time, and a WAV file.

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
  bool plays = true;   ///< false: to the file alone
  std::string device;  ///< SDL's name; "" the default one
  std::string file;    ///< "" for none
  int rate = 0;        ///< what the device and the file get [Hz]; 0: that of the first sound
  int channels = 0;    ///< the same
  double buffer = 1;   ///< how much may wait to be played before more is taken [s]
};

/// Plays sound and writes it to a file. Each change of the device is logged once.
class Player {
 public:
  static constexpr std::chrono::seconds kTimeout{1};
  static constexpr std::chrono::milliseconds kLook{100};  ///< how often look() is to be called
  /// @param stop  descriptor that is readable when waiting is to end.
  Player(PlayerOptions options, hc::LogSink log, int stop)
      : options_(std::move(options)), log_(std::move(log)), stop_(stop) {}

  /// Takes a sound; waits while more than `buffer` waits to be played. Without a device, or when it
  /// has played nothing for kTimeout, the sound is dropped and counted; the file gets it all the
  /// same.
  ///
  /// Errors: Unsupported (such a format), System.
  template <typename T>
  hc::Status play(std::span<const T> samples, const hc::audio::Format& format);
  /// The same of a message of that format, i16 or f32.
  hc::Status play(const hc::Message& message, const hc::audio::Format& format);

  /// Checks whether the device is connected, and opens it again.
  void look();
  /// Plays what is left, and waits until it has been played.
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
  std::optional<hc::audio::Format> format_;  // of device and file, once it is known
  std::optional<hc::audio::Converter> converter_;
  std::optional<hc::audio::WavWriter> writer_;
  bool file_error_ = false;
  std::unique_ptr<hc::audio::Playback> playback_;
  hc::Backoff backoff_;
  bool is_missing_ = false;               // and it is logged
  std::optional<std::int64_t> stuck_at_;  // frames that wait in a device that plays none
  std::int64_t dropped_ = 0, dropped_logged_ = 0;
};
