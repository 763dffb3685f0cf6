// SPDX-License-Identifier: Apache-2.0
#pragma once
// Client of a running graph: its state, its log, and commands to it (spec/graph.md, G45 … G47).

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

/// Communicates with a graph on a loop's thread; never blocks.
class GraphClient {
 public:
  /// Called on the loop's thread. They must not destroy the client.
  struct Callbacks {
    /// @param json  the state as received.
    std::function<void(const GraphState& state, std::string_view json)> state;
    /// @param json  the line as received.
    std::function<void(const LogLine& line, std::string_view json)> log = [](const auto&, auto) {};
    /// The graph has ended or cannot be read. No further calls follow.
    std::function<void()> end = [] {};
  };
  /// Takes the graph's answer. Errors: Closed (the graph has ended or does not answer), TooLarge
  /// (256 commands are waiting), System.
  using Answered = std::function<void(const Result<GraphAnswer>& answer)>;

  GraphClient(Loop& loop, RunningGraph graph);
  ~GraphClient();
  GraphClient(const GraphClient&) = delete;
  GraphClient& operator=(const GraphClient&) = delete;

  /// Subscribes to states and log: a state at once, twice a second, and after each change.
  /// Errors: Closed (the graph has ended), System.
  Status watch(Callbacks callbacks);

  /// Sends commands, all or none of which the graph executes. `answered` is called once, unless the
  /// client is destroyed first.
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
  std::optional<Callbacks> callbacks_;  // set by watch()
  std::unique_ptr<internal::Intake> states_, answers_;
  std::unique_ptr<Sink> commands_;
  std::string reply_;                        // URI for answers
  std::map<std::int64_t, Waiting> waiting_;  // by sequence number
  std::int64_t sent_ = 0;
  bool is_alive_ = true;  // the graph has sent something since the last check()
  Loop::Handle check_;
};

/// Like GraphClient::command(), but waits for the answer.
///
/// @param stop  descriptor that ends the wait when it is readable; -1: none.
/// Errors: those of Answered, and Stopped.
Result<GraphAnswer> ask(const RunningGraph& graph, std::vector<std::string> commands,
                        int stop = -1);

}  // namespace hc
