// SPDX-License-Identifier: Apache-2.0
#include <drivers/joystick/joystick.h>

#include <SDL2/SDL.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <string_view>
#include <utility>

#include <drivers/joystick/device_file.h>

namespace hc {
namespace {

using std::chrono::milliseconds;

constexpr int kMostAxes = 32, kMostButtons = 64;
constexpr Uint32 kTakenTime = 1000;  // [ms]
constexpr milliseconds kWatched{20}, kUnwatched{1}, kNoJoystick{100};

double as_number(Sint16 value) {
  return std::max(value / 32767.0, -1.0);
}

/// x and y of a hat, right and down > 0.
std::array<double, 2> as_axes(Uint8 hat) {
  const auto side = [hat](Uint8 more, Uint8 less) {
    return static_cast<double>((hat & more) != 0) - static_cast<double>((hat & less) != 0);
  };
  return {side(SDL_HAT_RIGHT, SDL_HAT_LEFT), side(SDL_HAT_DOWN, SDL_HAT_UP)};
}

template <typename T>
bool put(std::vector<T>& all, int at, T value) {
  if (at < 0 || static_cast<std::size_t>(at) >= all.size()) return false;
  return std::exchange(all[static_cast<std::size_t>(at)], value) != value;
}

}  // namespace

/// The open joystick: SDL's handle, and its device file for poll().
struct Joystick::Device {
  SDL_GameController* controller = nullptr;  // null for a joystick without a mapping
  SDL_Joystick* joystick = nullptr;
  SDL_JoystickID id = -1;
  int axes = 0;  // before those of its hats
  DeviceFile file;

  ~Device() {
    if (controller != nullptr)
      SDL_GameControllerClose(controller);
    else if (joystick != nullptr)
      SDL_JoystickClose(joystick);
  }
  /// Each descriptor of a device file gets all events, so reading here does not take SDL's.
  void open_file() {
    const char* path = SDL_JoystickPath(joystick);
    if (path != nullptr && std::string_view(path).starts_with("/dev/"))
      file = DeviceFile::open(path);
  }
  void drain_file() {
    std::array<char, 4096> bytes;
    ssize_t size = 0;
    while (file.file && (size = ::read(file.file.get(), bytes.data(), bytes.size())) > 0) continue;
    if (size == 0 || (errno != EAGAIN && errno != EINTR)) file.file.reset();  // unplugged
  }
};

Joystick::Joystick() = default;

Result<std::unique_ptr<Joystick>> Joystick::open() {
  SDL_SetHint(SDL_HINT_JOYSTICK_ALLOW_BACKGROUND_EVENTS, "1");  // we have no window
  SDL_SetHint(SDL_HINT_NO_SIGNAL_HANDLERS, "1");
  if (SDL_InitSubSystem(SDL_INIT_GAMECONTROLLER) != 0)
    return Error{Code::System, std::string("SDL: ") + SDL_GetError()};
  std::unique_ptr<Joystick> joystick(new Joystick());
  joystick->attach_any();
  return joystick;
}

Joystick::~Joystick() {
  device_.reset();
  SDL_QuitSubSystem(SDL_INIT_GAMECONTROLLER);
}

milliseconds Joystick::pace() const {
  if (device_ == nullptr) return kNoJoystick;
  return device_->file.file ? kWatched : kUnwatched;
}

int Joystick::descriptor() const {
  return device_ == nullptr ? -1 : device_->file.file.get();
}

bool Joystick::update() {
  // There is no event when another process releases a joystick.
  if (device_ == nullptr && !taken_.empty() && SDL_TICKS_PASSED(SDL_GetTicks(), look_again_) &&
      attach_any())
    return true;
  if (device_ != nullptr) device_->drain_file();
  bool changed = false;
  SDL_Event event;
  while (SDL_PollEvent(&event) != 0) {
    const bool is_controller = device_ != nullptr && device_->controller != nullptr;
    const auto is_ours = [&](SDL_JoystickID id, bool of_controller) {
      return device_ != nullptr && device_->id == id && is_controller == of_controller;
    };
    switch (event.type) {
      case SDL_JOYDEVICEADDED:
        if (device_ == nullptr && attach_any()) return true;
        break;
      case SDL_JOYDEVICEREMOVED:
        if (device_ == nullptr || device_->id != event.jdevice.which) break;
        detach();
        attach_any();  // there may be a second one
        return true;
      case SDL_CONTROLLERAXISMOTION:
        if (is_ours(event.caxis.which, true))
          changed |= put(state_.axes, event.caxis.axis, as_number(event.caxis.value));
        break;
      case SDL_JOYAXISMOTION:
        if (is_ours(event.jaxis.which, false))
          changed |= put(state_.axes, event.jaxis.axis, as_number(event.jaxis.value));
        break;
      case SDL_JOYHATMOTION:
        if (is_ours(event.jhat.which, false)) {
          const auto [x, y] = as_axes(event.jhat.value);
          const int at = device_->axes + 2 * event.jhat.hat;
          changed |= put(state_.axes, at, x);
          changed |= put(state_.axes, at + 1, y);
        }
        break;
      case SDL_CONTROLLERBUTTONDOWN:
      case SDL_CONTROLLERBUTTONUP:
        if (is_ours(event.cbutton.which, true) &&
            put(state_.buttons, event.cbutton.button, event.cbutton.state))
          return true;
        break;
      case SDL_JOYBUTTONDOWN:
      case SDL_JOYBUTTONUP:
        if (is_ours(event.jbutton.which, false) &&
            put(state_.buttons, event.jbutton.button, event.jbutton.state))
          return true;
        break;
      default:
        break;
    }
  }
  return changed;
}

/// Opens the first free joystick, game controllers before others.
bool Joystick::attach_any() {
  taken_.clear();
  look_again_ = SDL_GetTicks() + kTakenTime;
  for (bool wants_controller : {true, false})
    for (int i = 0; i < SDL_NumJoysticks(); ++i) {
      if ((SDL_IsGameController(i) == SDL_TRUE) != wants_controller) continue;
      auto device = std::make_unique<Device>();
      if (wants_controller) {
        device->controller = SDL_GameControllerOpen(i);
        device->joystick = SDL_GameControllerGetJoystick(device->controller);
      } else {
        device->joystick = SDL_JoystickOpen(i);
      }
      if (device->joystick == nullptr) continue;
      device->id = SDL_JoystickInstanceID(device->joystick);
      device->open_file();
      const char* known = SDL_JoystickName(device->joystick);
      const std::string name = known == nullptr || *known == '\0' ? "joystick" : known;
      if (device->file.is_taken) {
        taken_ = name;
        continue;
      }
      state_.name = name;
      auto* controller = device->controller;
      const int axes = device->axes =
          controller != nullptr ? SDL_CONTROLLER_AXIS_MAX
                                : std::min(SDL_JoystickNumAxes(device->joystick), kMostAxes);
      const int buttons = controller != nullptr
                              ? SDL_CONTROLLER_BUTTON_MAX
                              : std::min(SDL_JoystickNumButtons(device->joystick), kMostButtons);
      state_.axes.clear();
      state_.buttons.clear();
      for (int k = 0; k < axes; ++k)
        state_.axes.push_back(as_number(
            controller != nullptr
                ? SDL_GameControllerGetAxis(controller, static_cast<SDL_GameControllerAxis>(k))
                : SDL_JoystickGetAxis(device->joystick, k)));
      for (int k = 0; k < buttons; ++k)
        state_.buttons.push_back(
            controller != nullptr
                ? SDL_GameControllerGetButton(controller, static_cast<SDL_GameControllerButton>(k))
                : SDL_JoystickGetButton(device->joystick, k));
      const int hats = controller != nullptr ? 0 : SDL_JoystickNumHats(device->joystick);
      for (int k = 0; k < std::min(hats, kMostAxes / 2); ++k) {
        const auto sides = as_axes(SDL_JoystickGetHat(device->joystick, k));
        state_.axes.insert(state_.axes.end(), sides.begin(), sides.end());
      }
      device_ = std::move(device);
      return true;
    }
  return false;
}

/// Closes an unplugged joystick and releases its buttons.
void Joystick::detach() {
  device_.reset();
  state_.name.clear();
  std::fill(state_.axes.begin(), state_.axes.end(), 0.0);
  std::fill(state_.buttons.begin(), state_.buttons.end(), std::uint8_t{0});
}

}  // namespace hc
