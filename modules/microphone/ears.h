// SPDX-License-Identifier: Apache-2.0
#pragma once
// What a microphone or a WAV file gives: pieces of sound with the time of their first frame.

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <hc/base/clock.h>
#include <hc/base/result.h>
#include <sound/capture.h>
#include <sound/converter.h>
#include <sound/wav.h>

/// A piece of sound.
struct Piece {
  std::vector<std::int16_t> samples;  ///< channels next to one another
  std::int64_t time = 0;              ///< of the first frame [ns since the Unix epoch]
};

/// A WAV file as sound of another format, in pieces of one length; the last may be shorter.
class FileEar {
 public:
  /// Errors: as WavReader::open and Converter::make.
  static hc::Result<FileEar> open(const std::string& path, const hc::audio::Format& format);

  /// The next piece, empty at the end. Errors: System.
  hc::Result<std::vector<std::int16_t>> next(std::size_t frames);

 private:
  FileEar(hc::audio::WavReader reader, hc::audio::Converter converter, std::size_t channels)
      : reader_(std::move(reader)), converter_(std::move(converter)), channels_(channels) {}

  hc::audio::WavReader reader_;
  hc::audio::Converter converter_;
  std::size_t channels_;
  std::vector<std::int16_t> ready_;
  bool is_finished_ = false;
};

/// A microphone that may not be there, go, give nothing for kPatience, and come back. What happens
/// to it is told once each.
class DeviceEar {
 public:
  static constexpr std::chrono::seconds kPatience{3};  ///< some servers begin late
  using Tell = std::function<void(std::string_view line)>;
  DeviceEar(std::string device, const hc::audio::Format& format, int frames, Tell tell)
      : device_(std::move(device)),
        format_(format),
        frames_(frames),
        tell_(std::move(tell)),
        times_(format.rate) {}

  /// Waits for the next piece, for so long at most, or until `stop` is readable.
  std::optional<Piece> next(std::chrono::milliseconds timeout, int stop);

 private:
  void look(hc::MonotonicTime now);

  std::string device_;
  hc::audio::Format format_;
  int frames_;
  Tell tell_;
  hc::audio::FrameClock times_;
  hc::audio::Retry retry_;
  std::unique_ptr<hc::audio::Capture> capture_;
  hc::MonotonicTime heard_at_{0};  // or opened
  bool was_there_ = false, told_missing_ = false, told_silent_ = false, told_lost_ = false;
};
