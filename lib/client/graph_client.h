// SPDX-License-Identifier: Apache-2.0
#pragma once
// A running graph from outside: its states, its log, and commands to it (spec/graph.md, G45 … G47).

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <hc/contract/graph_command.h>
#include <hc/contract/graph_state.h>
#include <hc/contract/log_line.h>
#include <hc/contract/running_graph.h>
#include <hc/link/intake.h>
#include <hc/link/link.h>
#include <hc/os/loop.h>

namespace hc {

/// Talks to a graph on the thread of a loop, and never waits.
class GraphClient {
 public:
  /// Called on the loop's thread. None may destroy the client.
  struct Callbacks {
    /// @param json  what it was read from.
    std::function<void(const GraphState& state, std::string_view json)> state;
    /// @param json  what it was read from.
    std::function<void(const LogLine& line, std::string_view json)> log = [](const auto&, auto) {};
    /// The graph has ended, or cannot be read: the last call.
    std::function<void()> end = [] {};
  };
  /// What the graph has answered. Errors: Closed (it has ended, or does not answer), TooLarge
  /// (256 commands are waiting), System.
  using Answered = std::function<void(const Result<GraphAnswer>& answer)>;

  GraphClient(Loop& loop, RunningGraph graph);
  ~GraphClient();
  GraphClient(const GraphClient&) = delete;
  GraphClient& operator=(const GraphClient&) = delete;

  /// Reads states and log from now on: a state at once, twice a second, and after each change.
  /// Errors: Closed (it has ended), System.
  Status watch(Callbacks callbacks);

  /// Has the graph do what commands say, all of them or none. `answered` is called once, or not at
  /// all where the client is destroyed before.
  void command(std::vector<std::string> lines, Answered answered);

  [[nodiscard]] const RunningGraph& graph() const { return graph_; }

 private:
  struct Waiting {
    Answered answered;
    Loop::TimePoint until;
  };

  Status open();
  void take(const Message& message);
  void take_answer(const Message& message);
  void end();
  void check();
  void fail(const Error& error);

  Loop& loop_;
  const RunningGraph graph_;
  std::optional<Callbacks> callbacks_;  // of watch()
  std::unique_ptr<internal::Intake> states_, answers_;
  std::unique_ptr<Sink> commands_;
  std::string reply_;                        // where answers go
  std::map<std::int64_t, Waiting> waiting_;  // by number
  std::int64_t sent_ = 0;
  bool is_alive_ = true;  // it has said something since the last check()
  Loop::Handle check_;
};

/// As GraphClient::command(), and waits for the answer.
///
/// @param stop  descriptor that is readable when waiting is to end; -1: none.
/// Errors: as there, and Stopped.
Result<GraphAnswer> ask(const RunningGraph& graph, std::vector<std::string> commands,
                        int stop = -1);

}  // namespace hc
