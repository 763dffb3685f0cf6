// SPDX-License-Identifier: Apache-2.0
#include <sound/converter.h>

#include <SDL2/SDL_audio.h>
#include <SDL2/SDL_error.h>

#include <algorithm>
#include <cmath>

#include <hc/base/check.h>

namespace hc::audio {
namespace {

SDL_AudioStream* stream_of(void* stream) {
  return static_cast<SDL_AudioStream*>(stream);
}

}  // namespace

void Converter::Free::operator()(void* stream) const {
  SDL_FreeAudioStream(stream_of(stream));
}

Result<Converter> Converter::make(Scalar scalar, const Format& from, const Format& to) {
  auto is_right = [](const Format& format) {
    return format.rate > 0 && format.channels > 0 && format.channels <= kMostChannels;
  };
  SDL_AudioStream* stream = nullptr;
  if (is_right(from) && is_right(to))
    stream = SDL_NewAudioStream(scalar == Scalar::F32 ? AUDIO_F32SYS : AUDIO_S16SYS,
                                static_cast<Uint8>(from.channels), from.rate, AUDIO_S16SYS,
                                static_cast<Uint8>(to.channels), to.rate);
  if (stream == nullptr)
    return Error{Code::Unsupported, "sound of " + text(from) + " as " + text(to)};
  return Converter(scalar, from, to, stream);
}

template <typename T>
void Converter::put_any(std::span<const T> samples) {
  SDL_AudioStreamPut(stream_of(stream_.get()), samples.data(),
                     static_cast<int>(samples.size_bytes()));
}

void Converter::put(std::span<const float> samples) {
  HC_CHECK(scalar_ == Scalar::F32 && !is_finished_);
  // A NaN would spoil its neighbours in resampling.
  std::vector<float> clean(samples.begin(), samples.end());
  for (float& each : clean) each = std::isnan(each) ? 0 : std::clamp(each, -1.0F, 1.0F);
  put_any<float>(clean);
  put_ += static_cast<std::int64_t>(samples.size()) / from_.channels;
}

void Converter::put(std::span<const std::int16_t> samples) {
  HC_CHECK(scalar_ == Scalar::I16 && !is_finished_);
  put_any(samples);
  put_ += static_cast<std::int64_t>(samples.size()) / from_.channels;
}

void Converter::finish() {
  if (is_finished_) return;
  is_finished_ = true;
  // SDL holds back about 20 ms, even when flushed; appended silence pushes them out.
  const auto size = static_cast<std::size_t>(from_.rate / 5 * from_.channels);
  if (scalar_ == Scalar::F32)
    put_any<float>(std::vector<float>(size));
  else
    put_any<std::int16_t>(std::vector<std::int16_t>(size));
  SDL_AudioStreamFlush(stream_of(stream_.get()));
}

std::vector<std::int16_t> Converter::take() {
  const int bytes = SDL_AudioStreamAvailable(stream_of(stream_.get()));
  std::vector<std::int16_t> samples(static_cast<std::size_t>(std::max(bytes, 0)) / 2);
  const int got = SDL_AudioStreamGet(stream_of(stream_.get()), samples.data(),
                                     static_cast<int>(samples.size() * sizeof(std::int16_t)));
  std::int64_t frames = std::max(got, 0) / 2 / to_.channels;
  if (is_finished_)
    frames = std::clamp<std::int64_t>(put_ * to_.rate / from_.rate - taken_, 0, frames);
  taken_ += frames;
  samples.resize(static_cast<std::size_t>(frames * to_.channels));
  return samples;
}

}  // namespace hc::audio
