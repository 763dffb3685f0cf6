// SPDX-License-Identifier: Apache-2.0
// hc top: what a running graph does, live.
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include "common.h"
#include "observer.h"
#include "screen.h"
#include "verbs.h"

namespace tool {
namespace {

/// A terminal that shows one page and gives keys one by one, until this goes.
class Page {
 public:
  Page() {
    if (::tcgetattr(STDIN_FILENO, &before_) == 0) {
      termios raw = before_;
      raw.c_lflag &= static_cast<tcflag_t>(~(ICANON | ECHO));
      has_keys_ = ::tcsetattr(STDIN_FILENO, TCSANOW, &raw) == 0;
    }
    print("\x1b[?1049h\x1b[?25l");
  }
  ~Page() {
    print("\x1b[?25h\x1b[?1049l");
    if (has_keys_) ::tcsetattr(STDIN_FILENO, TCSANOW, &before_);
  }
  Page(const Page&) = delete;
  Page& operator=(const Page&) = delete;

  [[nodiscard]] int keys() const { return has_keys_ ? STDIN_FILENO : -1; }

  static Screen screen() {
    winsize size{};
    Screen screen;
    if (::ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0)
      screen = {size.ws_col, size.ws_row, false};
    --screen.height;  // the cursor's line stays empty
    return screen;
  }

  /// Puts a page over the last one without flicker.
  static void show(const std::string& text) {
    std::string page = "\x1b[H";
    for (char c : text) page += c == '\n' ? std::string("\x1b[K\n") : std::string(1, c);
    print(page + "\x1b[J");
  }

 private:
  termios before_{};
  bool has_keys_ = false;
};

void top(const std::string& name, bool once) {
  auto graph = choose_running(name);
  Observer observer(graph);
  if (once || ::isatty(STDOUT_FILENO) == 0) {
    auto state = observer.next_measured();
    if (!state) throw Failure(hc::Error{hc::Code::Closed, graph.text() + " has ended"});
    print(draw(*state, {80, 0, true}));
    return;
  }
  Page page;
  while (auto state = observer.next(page.keys())) {
    if (!state->empty()) {
      Page::show(draw(*state, Page::screen()));
      continue;
    }
    char key = 0;
    if (::read(STDIN_FILENO, &key, 1) != 1 || key == 'q') return;
  }
}

}  // namespace

void add_top(CLI::App& app) {
  struct Options {
    std::string graph;
    bool once = false;
  };
  auto options = std::make_shared<Options>();
  auto* verb = app.add_subcommand("top", "Show what a running graph does, live; q ends it");
  verb->add_option("graph", options->graph, "its name, where several run (hc ps)");
  verb->add_flag("--once", options->once, "print it once, as without a terminal");
  verb->callback([options] { top(options->graph, options->once); });
}

}  // namespace tool
