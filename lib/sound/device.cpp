// SPDX-License-Identifier: Apache-2.0
#include <sound/device.h>

#include <SDL2/SDL.h>
#include <dlfcn.h>

#include <utility>

namespace hc::audio {

constexpr std::chrono::milliseconds kMostDrift{50};

namespace {

void say_nothing(const char*, int, const char*, int, const char*, ...) {}

/// Silences ALSA, which prints several lines for a missing device; SDL_GetError() reports it, too.
void hush_alsa() {
  using SetHandler = int (*)(decltype(&say_nothing));
  static void* const alsa =
      ::dlopen("libasound.so.2", RTLD_LAZY);  // the one SDL uses, if installed
  if (alsa == nullptr) return;
  if (auto set = reinterpret_cast<SetHandler>(::dlsym(alsa, "snd_lib_error_set_handler")))
    set(say_nothing);
}

}  // namespace

Result<AudioSystem> start_audio() {
  SDL_SetHint(SDL_HINT_NO_SIGNAL_HANDLERS, "1");
  // SDL would print errors, which are in SDL_GetError(), too.
  SDL_LogSetOutputFunction([](void*, int, SDL_LogPriority, const char*) {}, nullptr);
  hush_alsa();
  if (SDL_InitSubSystem(SDL_INIT_AUDIO) != 0)
    return Error{Code::System, std::string("no sound: ") + SDL_GetError()};
  return AudioSystem(nullptr, [](void*) { SDL_QuitSubSystem(SDL_INIT_AUDIO); });
}

Time FrameClock::stamp(std::int64_t frames, Time now) {
  Time end = start_.value_or(Time()) + duration_of(counted_ + frames, rate_);
  if (!start_ || std::chrono::abs(end - now) > kMostDrift) {
    start_ = now - duration_of(frames, rate_);
    counted_ = 0;
    end = now;
  }
  const Time first = *start_ + duration_of(counted_, rate_);
  counted_ += frames;
  return first;
}

}  // namespace hc::audio
