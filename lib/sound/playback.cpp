// SPDX-License-Identifier: Apache-2.0
#include <sound/playback.h>

#include <SDL2/SDL.h>

namespace hc::audio {
namespace {

constexpr int kBuffersPerSecond = 100;  // minimum latency of 10 ms

}  // namespace

Result<std::unique_ptr<Playback>> Playback::open(const std::string& device, const Format& format) {
  auto system = HC_TRY(start_audio());
  SDL_AudioSpec wanted{}, got{};
  wanted.freq = format.rate;
  wanted.format = AUDIO_S16SYS;
  wanted.channels = static_cast<Uint8>(format.channels);
  wanted.samples = 64;
  while (wanted.samples < format.rate / kBuffersPerSecond)  // devices want powers of 2
    wanted.samples = static_cast<Uint16>(2 * wanted.samples);
  const auto id =
      SDL_OpenAudioDevice(device.empty() ? nullptr : device.c_str(), 0, &wanted, &got, 0);
  if (id == 0)
    return Error{Code::System, (device.empty() ? "loudspeaker" : "loudspeaker \"" + device + "\"") +
                                   ": " + SDL_GetError()};
  SDL_PauseAudioDevice(id, 0);
  return std::unique_ptr<Playback>(new Playback(std::move(system), id, format));
}

Playback::~Playback() {
  SDL_CloseAudioDevice(device_);
}

void Playback::put(std::span<const std::int16_t> samples) {
  SDL_QueueAudio(device_, samples.data(), static_cast<Uint32>(samples.size_bytes()));
}

std::int64_t Playback::waiting() const {
  return std::int64_t{SDL_GetQueuedAudioSize(device_)} / (2 * format_.channels);
}

bool Playback::is_there() const {
  return SDL_GetAudioDeviceStatus(device_) != SDL_AUDIO_STOPPED;
}

}  // namespace hc::audio
