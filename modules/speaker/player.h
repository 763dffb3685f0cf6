// SPDX-License-Identifier: Apache-2.0
#pragma once
// Where sound goes: a loudspeaker that may not be there, go, and come back, and a WAV file.

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include <hc/base/clock.h>
#include <hc/base/result.h>
#include <sound/converter.h>
#include <sound/playback.h>
#include <sound/wav.h>

struct PlayerOptions {
  bool is_heard = true;  ///< false: to the file alone
  std::string device;    ///< SDL's name; "" the default one
  std::string file;      ///< "" for none
  int rate = 0;          ///< what the device and the file get [Hz]; 0: that of the first sound
  int channels = 0;      ///< the same
  double buffer = 1;     ///< how much may wait to be played before more is taken [s]
};

/// Plays sound and writes it down. What happens to the device is told once each.
class Player {
 public:
  static constexpr std::chrono::seconds kPatience{1};
  using Tell = std::function<void(std::string_view line)>;
  /// @param stop  descriptor that is readable when waiting is to end.
  Player(PlayerOptions options, Tell tell, int stop)
      : options_(std::move(options)), tell_(std::move(tell)), stop_(stop) {}

  /// Takes a sound; waits while more than `buffer` waits to be played. While there is no device, or
  /// it has taken nothing for kPatience, the sound is lost to it, and counted; it goes to the file
  /// all the same.
  ///
  /// Errors: Unsupported (such a format), System, TooLarge (the file).
  template <typename T>
  hc::Status play(std::span<const T> samples, const hc::audio::Format& format);

  /// Looks after the device: whether it has gone, or has come back.
  void look();
  /// Gives out what is left, and waits until it has been played.
  hc::Status finish();

  /// Sounds that were lost since there was no device.
  [[nodiscard]] std::int64_t dropped() const { return dropped_; }

 private:
  hc::Status prepare(hc::audio::Converter::Scalar scalar, const hc::audio::Format& format);
  hc::Status give_out();
  void wait_until_at_most(double seconds);
  void look_whether_stuck();

  PlayerOptions options_;
  Tell tell_;
  int stop_;
  std::optional<hc::audio::Format> format_;  // of device and file, once it is known
  std::optional<hc::audio::Converter> converter_;
  std::optional<hc::audio::WavWriter> writer_;
  std::unique_ptr<hc::audio::Playback> playback_;
  hc::audio::Retry retry_;
  bool told_missing_ = false;
  std::optional<std::int64_t> stuck_at_;  // frames that wait, since the device takes none
  std::int64_t dropped_ = 0, dropped_told_ = 0;
};
