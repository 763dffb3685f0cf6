// SPDX-License-Identifier: Apache-2.0
#include <vision/window.h>

#include <algorithm>
#include <cstdlib>
#include <vector>

#include <SDL2/SDL.h>
#include <hc/base/format.h>
#include <hc/os/new_file.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace hc::vision {
namespace {

template <auto Destroy>
struct Destroyer {
  template <typename T>
  void operator()(T* thing) const {
    Destroy(thing);
  }
};

Error unsupported(const std::string& what) {
  return {Code::Unsupported, what + ": " + SDL_GetError()};
}

}  // namespace

/// Its members are empty after the user closed it.
struct Display::Window {
  std::unique_ptr<SDL_Window, Destroyer<SDL_DestroyWindow>> window;
  std::unique_ptr<SDL_Renderer, Destroyer<SDL_DestroyRenderer>> renderer;
  std::unique_ptr<SDL_Texture, Destroyer<SDL_DestroyTexture>> texture;
  cv::Size size;  // of the texture

  void close() {
    texture.reset();
    renderer.reset();
    window.reset();
  }
};

Display::Display(int monitor, cv::Size size) : monitor_(monitor), monitor_size_(size) {}

Display::~Display() {
  windows_.clear();
  SDL_QuitSubSystem(SDL_INIT_VIDEO);
}

Result<std::unique_ptr<Display>> Display::open(int monitor) {
  SDL_SetHint(SDL_HINT_NO_SIGNAL_HANDLERS, "1");
  SDL_SetHint(SDL_HINT_VIDEO_ALLOW_SCREENSAVER, "1");
  // Only visible displays; SDL has others. SDL_VIDEODRIVER overrides this.
  SDL_SetHint(SDL_HINT_VIDEODRIVER,
              std::getenv("WAYLAND_DISPLAY") != nullptr ? "wayland,x11" : "x11");
  if (SDL_InitSubSystem(SDL_INIT_VIDEO) != 0) return unsupported("no display");
  cv::Size size;
  SDL_DisplayMode mode;
  if (monitor >= 0) {
    if (SDL_GetDesktopDisplayMode(monitor, &mode) != 0) {
      const int count = SDL_GetNumVideoDisplays();
      SDL_QuitSubSystem(SDL_INIT_VIDEO);
      return Error{Code::Unsupported,
                   hc::format("no monitor {}, only {}", monitor,
                              count == 1 ? "0" : hc::format("0 … {}", count - 1))};
    }
    size = {mode.w, mode.h};
  }
  return std::unique_ptr<Display>(new Display(monitor, size));
}

void Display::show(const std::string& title, const cv::Mat& bgr) {
  const bool is_new = !windows_.contains(title);
  Window& window = windows_[title];
  if (is_new) {
    const bool fills = monitor_ >= 0;
    const cv::Size size = fills ? monitor_size_ : bgr.size();
    const auto place = fills ? static_cast<int>(SDL_WINDOWPOS_CENTERED_DISPLAY(monitor_))
                             : static_cast<int>(SDL_WINDOWPOS_UNDEFINED);
    window.window.reset(
        SDL_CreateWindow(title.c_str(), place, place, size.width, size.height,
                         fills ? SDL_WINDOW_FULLSCREEN_DESKTOP : SDL_WINDOW_RESIZABLE));
    if (!window.window) return;
    if (fills) SDL_ShowCursor(SDL_DISABLE);
    window.renderer.reset(SDL_CreateRenderer(window.window.get(), -1, SDL_RENDERER_PRESENTVSYNC));
  }
  if (!window.renderer) return;
  if (!window.texture || window.size != bgr.size()) {
    window.size = bgr.size();
    window.texture.reset(SDL_CreateTexture(window.renderer.get(), SDL_PIXELFORMAT_BGR24,
                                           SDL_TEXTUREACCESS_STREAMING, bgr.cols, bgr.rows));
    // Adds bars if the aspect ratios of image and window differ.
    SDL_RenderSetLogicalSize(window.renderer.get(), bgr.cols, bgr.rows);
  }
  cv::Mat coloured = bgr;
  if (bgr.channels() == 1) cv::cvtColor(bgr, coloured, cv::COLOR_GRAY2BGR);
  SDL_UpdateTexture(window.texture.get(), nullptr, coloured.data,
                    static_cast<int>(coloured.step[0]));
  SDL_RenderClear(window.renderer.get());
  SDL_RenderCopy(window.renderer.get(), window.texture.get(), nullptr, nullptr);
  SDL_RenderPresent(window.renderer.get());
}

bool Display::any_open() {
  SDL_Event event;
  while (SDL_PollEvent(&event) != 0) {
    const bool is_all = event.type == SDL_KEYDOWN || event.type == SDL_QUIT;
    const bool is_one =
        event.type == SDL_WINDOWEVENT && event.window.event == SDL_WINDOWEVENT_CLOSE;
    if (!is_all && !is_one) continue;
    for (auto& [title, window] : windows_)
      if (is_all ||
          (window.window && SDL_GetWindowID(window.window.get()) == event.window.windowID))
        window.close();
  }
  return std::any_of(windows_.begin(), windows_.end(),
                     [](const auto& each) { return each.second.window != nullptr; });
}

Status save_image(const std::filesystem::path& path, const cv::Mat& bgr) {
  std::error_code error;
  if (path.has_parent_path()) std::filesystem::create_directories(path.parent_path(), error);
  if (error) return Error{Code::System, path.string() + ": " + error.message()};
  std::vector<unsigned char> png;
  if (!cv::imencode(".png", bgr, png))
    return Error{Code::Unsupported, path.string() + ": OpenCV cannot make a PNG of it"};
  return replace_file(path, {reinterpret_cast<const char*>(png.data()), png.size()});
}

}  // namespace hc::vision
