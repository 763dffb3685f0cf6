// SPDX-License-Identifier: Apache-2.0
#pragma once
// Format of sound: sample rate and channels; and the coordinate systems of sample rates
// (spec/mtp-1.md, R44). Pure.

#include <array>
#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

namespace hc::audio {

inline constexpr int kMostChannels = 8;

struct Format {
  int rate = 0;      ///< sample rate [Hz]
  int channels = 0;  ///< 1 … kMostChannels
  bool operator==(const Format&) const = default;
};

/// Duration of a number of frames; split, so that no product overflows within a century.
constexpr std::chrono::nanoseconds duration_of(std::int64_t frames, std::int64_t rate) {
  constexpr std::chrono::nanoseconds kSecond = std::chrono::seconds(1);
  return frames / rate * kSecond + frames % rate * kSecond / rate;
}

/// "16000 Hz, 2 channels"
inline std::string text(const Format& format) {
  return std::to_string(format.rate) + " Hz, " + std::to_string(format.channels) +
         (format.channels == 1 ? " channel" : " channels");
}

/// The rates with a coordinate system, 20, 21, … [Hz].
inline constexpr std::array<int, 5> kRates = {8000, 16000, 22050, 44100, 48000};
inline constexpr std::int32_t kFirstCoord = 20;

/// The rate of a coordinate system [Hz]; nothing if it is not one of sound.
constexpr std::optional<int> rate_of(std::int32_t coord) {
  if (coord < kFirstCoord || coord >= kFirstCoord + static_cast<std::int32_t>(kRates.size()))
    return std::nullopt;
  return kRates[static_cast<std::size_t>(coord - kFirstCoord)];
}

/// The coordinate system of a rate; nothing if it has none.
constexpr std::optional<std::int32_t> coord_of(int rate) {
  for (std::size_t i = 0; i < kRates.size(); ++i)
    if (kRates[i] == rate) return kFirstCoord + static_cast<std::int32_t>(i);
  return std::nullopt;
}

}  // namespace hc::audio
