// SPDX-License-Identifier: Apache-2.0
#include <sound/device.h>

#include <SDL2/SDL.h>
#include <dlfcn.h>

#include <cstdlib>
#include <utility>

namespace hc::audio {

constexpr std::int64_t kSecond = 1'000'000'000;  // [ns]
constexpr std::int64_t kMostDrift = 50'000'000;  // [ns]

namespace {

void say_nothing(const char*, int, const char*, int, const char*, ...) {}

/// ALSA, where SDL uses it, prints several lines whenever a device is not there; SDL_GetError()
/// says that too.
void hush_alsa() {
  using SetHandler = int (*)(decltype(&say_nothing));
  static void* const alsa = ::dlopen("libasound.so.2", RTLD_LAZY);  // as SDL does, if it is there
  if (alsa == nullptr) return;
  if (auto set = reinterpret_cast<SetHandler>(::dlsym(alsa, "snd_lib_error_set_handler")))
    set(say_nothing);
}

}  // namespace

Result<AudioSystem> AudioSystem::start() {
  SDL_SetHint(SDL_HINT_NO_SIGNAL_HANDLERS, "1");
  // It would print; what fails is in SDL_GetError() too.
  SDL_LogSetOutputFunction([](void*, int, SDL_LogPriority, const char*) {}, nullptr);
  hush_alsa();
  if (SDL_InitSubSystem(SDL_INIT_AUDIO) != 0)
    return Error{Code::System, std::string("no sound: ") + SDL_GetError()};
  return AudioSystem();
}

AudioSystem::AudioSystem(AudioSystem&& other) noexcept
    : is_held_(std::exchange(other.is_held_, false)) {}

AudioSystem::~AudioSystem() {
  if (is_held_) SDL_QuitSubSystem(SDL_INIT_AUDIO);
}

std::int64_t FrameClock::stamp(std::int64_t frames, std::int64_t now) {
  // Split, so that no product is too large within a century.
  auto length = [&](std::int64_t count) {
    return count / rate_ * kSecond + count % rate_ * kSecond / rate_;
  };
  std::int64_t end = start_.value_or(0) + length(counted_ + frames);
  if (!start_ || std::abs(end - now) > kMostDrift) {
    start_ = now - length(frames);
    counted_ = 0;
    end = now;
  }
  const std::int64_t first = *start_ + length(counted_);
  counted_ += frames;
  return first;
}

}  // namespace hc::audio
