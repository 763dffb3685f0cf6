// SPDX-License-Identifier: Apache-2.0
#pragma once
// Sound from a microphone or a WAV file, in messages with the time of their first frame.

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <hc/base/backoff.h>
#include <hc/base/clock.h>
#include <hc/base/log.h>
#include <hc/base/result.h>
#include <sound/capture.h>
#include <sound/converter.h>
#include <sound/messages.h>
#include <sound/wav.h>

inline constexpr int kPiecesPerSecond = 50;  // of 20 ms

/// A piece of sound; its rate has a coordinate system.
using Piece = hc::MessageOf<hc::SoundKind<std::int16_t>>;

/// Reads a WAV file and converts it to a format. The last piece may be shorter.
class FileEar {
 public:
  /// @param start  time of its first frame. Errors: as WavReader::open and Converter::make.
  static hc::Result<FileEar> open(const std::string& path, const hc::audio::Format& format,
                                  hc::Time start = {});

  /// The next piece; nothing at the end. Errors: System.
  hc::Result<std::optional<Piece>> next();

 private:
  FileEar(hc::audio::WavReader reader, hc::audio::Converter converter,
          const hc::audio::Format& format, hc::Time start)
      : reader_(std::move(reader)),
        converter_(std::move(converter)),
        format_(format),
        start_(start) {}

  hc::audio::WavReader reader_;
  hc::audio::Converter converter_;
  hc::audio::Format format_;
  hc::Time start_;
  std::int64_t sent_ = 0;  // frames
  std::vector<std::int16_t> ready_;
  bool is_finished_ = false;
};

/// A microphone, which may disconnect or be silent for kTimeout at any time. Logs each change once.
class DeviceEar {
 public:
  static constexpr std::chrono::seconds kTimeout{3};      ///< some sound servers start late
  static constexpr std::chrono::milliseconds kLook{100};  ///< period of look()
  DeviceEar(std::string device, const hc::audio::Format& format, hc::LogSink log)
      : device_(std::move(device)), format_(format), log_(std::move(log)), times_(format.rate) {}

  /// Checks whether the device is connected, and reopens it if not.
  void look();
  /// For poll(): readable while there are pieces; -1 without a device.
  [[nodiscard]] int descriptor() const { return capture_ ? capture_->descriptor() : -1; }
  /// The next piece, if any. Never blocks.
  std::optional<Piece> next();

 private:
  std::string device_;
  hc::audio::Format format_;
  hc::LogSink log_;
  hc::audio::FrameClock times_;
  hc::Backoff backoff_;
  std::unique_ptr<hc::audio::Capture> capture_;
  hc::MonotonicTime heard_at_{0};  // last sound, or when opened
  bool is_missing_ = false, is_silent_ = false, has_lost_ = false;
};
