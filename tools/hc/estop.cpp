// SPDX-License-Identifier: Apache-2.0
// hc estop: stops the robot of a running graph, or clears its stops (doc/routing.md).
#include <chrono>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <client/tap.h>
#include <hc/base/clock.h>
#include <hc/mtp/message.h>
#include <hc/os/program.h>
#include <record/writer.h>

#include "common.h"
#include "observer.h"
#include "verbs.h"

namespace tool {
namespace {

using std::chrono::milliseconds;

constexpr std::uint8_t kStop = 1, kClear = 2;  // values of the input `stop`
constexpr milliseconds kConfirmation{2000};    // for the workspace to report it
constexpr milliseconds kRepetition{500};       // by then a page has repeated its stop

hc::Message make_stop(std::uint8_t value) {
  hc::Header header;
  header.info = {hc::MatrixType::Table, 1, hc::Scalar::U8, hc::Encoding::Binary};
  header.width = header.height = 1;
  header.time = hc::SystemClock().wall();
  hc::Draft draft = hc::Draft::make(header);
  draft.elements()[0] = std::byte{value};
  return std::move(draft).finish();
}

void send_to(const RunningGraph& graph, const std::string& input, const hc::Message& message) {
  hc::record::Place place{hc::record::Place::Kind::Link, {}, {}, {}};
  place.uri = value_or_fail(hc::feed_uri(graph, input, hc::stop_descriptor()));
  auto sink = value_or_fail(hc::record::open_sink(place, link_options()), input);
  send(*sink, message, input);
  if (auto closed = sink->close(); !closed) throw Failure(input, closed.error());
}

/// Sends to each workspace, also after another one has failed.
void send_to_all(const RunningGraph& graph, const hc::GraphState& state,
                 const hc::Message& message) {
  std::optional<Failure> failure;
  for (const auto& [workspace, mode] : state.focus) {
    try {
      send_to(graph, workspace + ".stop", message);
    } catch (const Failure& failed) {
      failure = failed;
    }
  }
  if (failure) throw Failure(*failure);
}

/// Why a workspace does not report what it was told.
std::string why_not(const hc::GraphState& state, bool clears) {
  const std::string what = clears ? "NOT cleared: " : "stop NOT confirmed: ";
  for (const auto& [workspace, mode] : state.focus)
    if (state.stopped.contains(workspace) == clears &&
        find_module(state, workspace).status != hc::ModuleStatus::Running)
      return what + workspace + " does not run, or hangs";
  if (!clears) return what + "the workspace does not report it";
  return what + state.stopped_in_words() +
         "; a source that repeats its stop, as a page does, must clear it: hc page prints the URL "
         "of "
         "a page";
}

/// Sends to all workspaces of a graph, and waits until they report that the robot is stopped, or
/// that it is not and that no source has stopped it again. False: the graph has no workspace.
bool estop(const RunningGraph& graph, bool clears) {
  Observer observer(graph);
  auto state = observer.next();
  if (state && state->focus.empty()) return false;
  if (state) send_to_all(graph, *state, make_stop(clears ? kClear : kStop));
  const auto sent = std::chrono::steady_clock::now();
  for (; state; state = observer.next()) {
    const auto waited = std::chrono::steady_clock::now() - sent;
    const bool is_done = clears ? state->stopped.empty() && waited >= kRepetition
                                : state->stopped.size() == state->focus.size();
    if (is_done) {
      say("hc estop: " + graph.text() +
          (clears ? " may move"
                  : " is stopped; hc estop clear --of " + graph.name + " lets it move again"));
      return true;
    }
    if (waited > kConfirmation) throw Failure(hc::Code::Closed, why_not(*state, clears));
  }
  throw Failure(hc::Code::Closed, graph.text() + " has ended");
}

/// Stops the robots of all graphs, at once, since one that hangs must not delay the others.
void stop_all() {
  std::vector<std::future<bool>> stops;
  for (const auto& graph : find_running())
    stops.push_back(std::async(std::launch::async, estop, graph, false));
  bool is_any = false;
  std::optional<Failure> failure;
  for (auto& stop : stops) {
    try {
      is_any = stop.get() || is_any;
    } catch (const Failure& failed) {
      failure = failed;
    }
  }
  if (failure) throw Failure(*failure);
  if (!is_any) throw Failure(hc::Code::NotFound, "no graph with a workspace is running here");
}

}  // namespace

void add_estop(CLI::App& app) {
  struct Options {
    std::string word, of;
  };
  auto options = std::make_shared<Options>();
  auto* verb = app.add_subcommand(
      "estop", "Stop the robots of all graphs, or of one; estop clear lets one move again");
  verb->add_option("clear", options->word, "\"clear\" clears all stops of a graph")
      ->check(CLI::IsMember({"clear"}));
  add_of(*verb, options->of);
  verb->callback([options] {
    const bool clears = !options->word.empty();
    if (!clears && options->of.empty()) return stop_all();
    const auto graph = choose_running(options->of);
    if (!estop(graph, clears))
      throw Failure(
          hc::Code::NotFound,
          graph.text() + " has no workspace (table [workspace] in its file), so nothing to stop");
  });
}

}  // namespace tool
