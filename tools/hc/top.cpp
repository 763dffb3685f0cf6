// SPDX-License-Identifier: Apache-2.0
// hc top: shows a running graph, live.
#include <poll.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <limits>

#include <hc/mtp/matrix_view.h>

#include "common.h"
#include "observer.h"
#include "screen.h"
#include "verbs.h"

namespace tool {
namespace {

/// A terminal with a full-screen page and unbuffered keys, restored by the destructor.
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

  [[nodiscard]] std::vector<int> keys() const {
    return has_keys_ ? std::vector{STDIN_FILENO} : std::vector<int>();
  }

  static Screen screen() {
    const auto size = terminal_size();
    return {size.width, size.height - 1};  // the last line is for the cursor
  }

  /// Overwrites the last page without flicker.
  static void show(const std::string& text) {
    std::string page = "\x1b[H";
    for (char c : text) page += c == '\n' ? std::string("\x1b[K\n") : std::string(1, c);
    print(page + "\x1b[J");
  }

 private:
  termios before_{};
  bool has_keys_ = false;
};

/// The bids of a graph's workspaces, if their modules publish them.
class Bids {
 public:
  Bids(const RunningGraph& graph, const hc::GraphState& state) {
    for (const auto& [workspace, focus] : state.focus) try {
        all_.push_back({state.focus.size() > 1 ? workspace : "",
                        open_port(graph, workspace + ".standings"),
                        {}});
      } catch (const Failure&) {
        continue;  // no output `standings`
      }
  }

  std::vector<Bid> take(const hc::GraphState& state) {
    std::vector<Bid> all;
    hc::Message message;
    for (auto& [name, source, bids] : all_) {
      for (auto got = source->take(message); got && *got == hc::Got::Message;
           got = source->take(message))
        if (auto rows = hc::view<double>(message); rows && rows->width() == 5)
          bids = bids_of(name, *rows, state);
      all.insert(all.end(), bids.begin(), bids.end());
    }
    return all;
  }

 private:
  struct Workspace {
    std::string name;  // empty: the only one
    std::unique_ptr<hc::Source> source;
    std::vector<Bid> bids;
  };

  static std::vector<Bid> bids_of(const std::string& workspace,
                                  const hc::MatrixView<const double>& rows,
                                  const hc::GraphState& state) {
    std::vector<Bid> bids;
    for (std::size_t i = 0; i < rows.height(); ++i) {
      const auto row = rows.row(i);
      bids.push_back({workspace, state.mode_name(static_cast<std::int64_t>(row[0])), row[1],
                      row[3] != 0, row[4] != 0});
    }
    return bids;
  }

  std::vector<Workspace> all_;
};

struct TopOptions {
  std::string graph;
  bool once = false, json = false;
};

/// The lines that a key scrolls.
int lines_of(std::string_view keys, int page) {
  if (keys == "k" || keys == "\x1b[A") return -1;
  if (keys == "j" || keys == "\x1b[B") return 1;
  if (keys == "\x1b[5~") return -page;
  return keys == "\x1b[6~" || keys == " " ? page : 0;
}

void show(Observer& observer, Bids& bids) {
  Page page;
  int first = 0;
  while (auto state = observer.next(page.keys())) {
    pollfd keys{page.keys().empty() ? -1 : STDIN_FILENO, POLLIN, 0};
    if (::poll(&keys, 1, 0) > 0) {
      char typed[16];
      const auto size = ::read(STDIN_FILENO, typed, sizeof typed);
      if (size <= 0 || typed[0] == 'q') return;
      const int height = static_cast<int>(Page::screen().height);
      first = std::max(0, first + lines_of({typed, static_cast<std::size_t>(size)}, height / 2));
    }
    auto screen = Page::screen();
    first = std::min(first, static_cast<int>(state->modules.size() + state->links.size()));
    screen.first = static_cast<std::size_t>(first);
    Page::show(draw(*state, bids.take(*state), screen));
  }
}

void top(const TopOptions& options) {
  const auto graph = choose_running(options.graph);
  Observer observer(graph);
  auto state = observer.next_measured();
  if (!state) throw Failure(hc::Code::Closed, graph.text() + " has ended");
  const bool is_live = !options.once && ::isatty(STDOUT_FILENO) == 1;
  if (options.json) {
    while (state && print(to_json(*state) + "\n") && !options.once) state = observer.next();
    return;
  }
  Bids bids(graph, *state);
  if (is_live) return show(observer, bids);
  if (auto later = observer.next()) state = later;  // bids arrive meanwhile
  print(draw(*state, bids.take(*state), {std::numeric_limits<std::size_t>::max(), 0, true}));
}

}  // namespace

void add_top(CLI::App& app) {
  auto options = std::make_shared<TopOptions>();
  auto* verb = app.add_subcommand("top", "Show a running graph live: modules, links, focus");
  add_of(*verb, options->graph);
  verb->add_flag("--once", options->once, "print once, as without a terminal");
  verb->add_flag("--json", options->json, "print states as lines of JSON, twice a second");
  verb->callback([options] { top(*options); });
}

}  // namespace tool
