// SPDX-License-Identifier: Apache-2.0
#pragma once
// Converts sound between formats: rate, channels, scalar. For one thread at a time.

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <hc/base/result.h>
#include <sound/format.h>

namespace hc::audio {

/// Converts f32 or i16 to i16. If the rates differ, the output is slightly delayed.
class Converter {
 public:
  enum class Scalar { I16, F32 };

  /// Errors: Unsupported (SDL cannot do it).
  static Result<Converter> make(Scalar scalar, const Format& from, const Format& to);

  [[nodiscard]] bool takes(Scalar scalar, const Format& from) const {
    return scalar == scalar_ && from == from_;
  }

  /// @param samples  interleaved channels, clipped to −1 … 1; NaN is silence.
  void put(std::span<const float> samples);
  void put(std::span<const std::int16_t> samples);
  /// Ends the input, so that take() returns the rest; no put() may follow.
  void finish();
  /// Takes the converted samples, in whole frames.
  std::vector<std::int16_t> take();

 private:
  struct Free {
    void operator()(void* stream) const;
  };
  Converter(Scalar scalar, const Format& from, const Format& to, void* stream)
      : scalar_(scalar), from_(from), to_(to), stream_(stream) {}
  template <typename T>
  void put_any(std::span<const T> samples);

  Scalar scalar_;
  Format from_, to_;
  std::unique_ptr<void, Free> stream_;  // an SDL_AudioStream
  std::int64_t put_ = 0, taken_ = 0;    // frames
  bool is_finished_ = false;
};

}  // namespace hc::audio
