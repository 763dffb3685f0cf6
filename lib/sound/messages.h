// SPDX-License-Identifier: Apache-2.0
#pragma once
// Converts sound to messages, whose coordinate system is the sample rate (spec/mtp-1.md, R44), and
// back. Header only. Pure.

#include <span>
#include <string>

#include <hc/base/check.h>
#include <hc/module/kind.h>
#include <sound/format.h>

namespace hc::audio {

/// A message of sound; its rate must have a coordinate system.
inline MessageOf<SoundKind<std::int16_t>> message_of(std::span<const std::int16_t> samples,
                                                     const Format& format) {
  const auto coord = coord_of(format.rate);
  HC_CHECK(coord, format.rate);
  return sound(format.channels).in(*coord).message(samples);
}

/// The format of a message of sound.
///
/// Errors: Unsupported (a coordinate system without a sample rate).
inline Result<Format> format_of(const Message& message) {
  const auto rate = rate_of(message.header.coord);
  if (!rate)
    return Error{Code::Unsupported,
                 "coordinate system " + coord_text(message.header.coord) + " has no sample rate"};
  return Format{*rate, message.header.info.components};
}

/// Sound of i16 and f32 in up to kMostChannels channels.
inline AnyKind any_sound() {
  AnyKind any;
  for (int channels = 1; channels <= kMostChannels; ++channels) {
    any.types.push_back(sound(channels).type);
    any.types.push_back(sound<float>(channels).type);
  }
  return any;
}

}  // namespace hc::audio
