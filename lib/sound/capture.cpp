// SPDX-License-Identifier: Apache-2.0
#include <sound/capture.h>

#include <SDL2/SDL.h>
#include <poll.h>
#include <unistd.h>

#include <array>
#include <cstring>
#include <deque>
#include <mutex>
#include <utility>

#include <hc/os/event.h>

namespace hc::audio {
namespace {

constexpr std::chrono::milliseconds kMostKept{2000};

}  // namespace

struct Capture::Queue {
  std::mutex mutex;
  std::deque<Heard> pieces;
  std::size_t most = 1;
  std::int64_t lost = 0;
  Event event;  // raised while there are pieces
  SystemClock clock;

  void put(const void* bytes, std::size_t size) {
    Heard heard;
    heard.time = clock.wall();
    heard.samples.resize(size / 2);
    std::memcpy(heard.samples.data(), bytes, heard.samples.size() * 2);
    const std::lock_guard lock(mutex);
    if (pieces.size() == most) {
      pieces.pop_front();
      ++lost;
    }
    pieces.push_back(std::move(heard));
    event.raise();
  }
  std::optional<Heard> take() {
    const std::lock_guard lock(mutex);
    if (pieces.size() <= 1) event.clear();
    if (pieces.empty()) return std::nullopt;
    auto heard = std::move(pieces.front());
    pieces.pop_front();
    return heard;
  }
};

Capture::Capture(AudioSystem system, std::unique_ptr<Queue> queue)
    : system_(std::move(system)), queue_(std::move(queue)) {}

Result<std::unique_ptr<Capture>> Capture::open(const std::string& device, const Format& format,
                                               int frames) {
  auto system = HC_TRY(start_audio());
  auto event = HC_TRY(Event::make());
  std::unique_ptr<Capture> capture(new Capture(std::move(system), std::make_unique<Queue>()));
  capture->queue_->event = std::move(event);
  const auto per_second = static_cast<std::size_t>(format.rate) / static_cast<std::size_t>(frames);
  capture->queue_->most =
      std::max<std::size_t>(1, per_second * static_cast<std::size_t>(kMostKept.count()) / 1000);
  SDL_AudioSpec wanted{}, got{};
  wanted.freq = format.rate;
  wanted.format = AUDIO_S16SYS;
  wanted.channels = static_cast<Uint8>(format.channels);
  wanted.samples = static_cast<Uint16>(frames);
  wanted.userdata = capture->queue_.get();
  wanted.callback = [](void* queue, Uint8* bytes, int size) {
    static_cast<Queue*>(queue)->put(bytes, static_cast<std::size_t>(size));
  };
  capture->device_ =
      SDL_OpenAudioDevice(device.empty() ? nullptr : device.c_str(), 1, &wanted, &got, 0);
  if (capture->device_ == 0)
    return Error{Code::System, (device.empty() ? "microphone" : "microphone \"" + device + "\"") +
                                   ": " + SDL_GetError()};
  SDL_PauseAudioDevice(capture->device_, 0);
  return capture;
}

Capture::~Capture() {
  if (device_ != 0) SDL_CloseAudioDevice(device_);
}

std::optional<Heard> Capture::take(std::chrono::milliseconds timeout, int stop) {
  if (auto heard = queue_->take()) return heard;
  std::array<pollfd, 2> waiting = {pollfd{queue_->event.descriptor(), POLLIN, 0},
                                   pollfd{stop, POLLIN, 0}};
  ::poll(waiting.data(), waiting.size(), static_cast<int>(timeout.count()));
  return queue_->take();
}

int Capture::descriptor() const {
  return queue_->event.descriptor();
}

bool Capture::is_there() const {
  return SDL_GetAudioDeviceStatus(device_) != SDL_AUDIO_STOPPED;
}

std::int64_t Capture::lost() const {
  const std::lock_guard lock(queue_->mutex);
  return queue_->lost;
}

}  // namespace hc::audio
