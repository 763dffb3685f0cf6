// SPDX-License-Identifier: Apache-2.0
#pragma once
// The two links that a graph which runs has for others of the same user: it publishes its state and
// its log over one, and takes commands over the other (spec/graph.md). Internal to graph.

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <graph/run/announcer.h>
#include <graph/run/intake.h>
#include <graph/state.h>

namespace hc::internal {

class Observation {
 public:
  using Answer = std::function<void(const std::vector<std::string>& wrong)>;
  struct Asked {
    std::function<GraphState()> state;
    /// Does what commands say, all of them or none; then or later it answers what is wrong with
    /// them, if anything.
    std::function<void(const std::vector<std::string>& commands, Answer answer)> obey;
    /// Gives the URI of an observation of "MODULE.PORT". Errors: Invalid.
    std::function<Result<std::string>(const std::string& port)> observe;
    /// Gives what a module's program says of itself, one line of JSON. Errors: Invalid.
    std::function<Result<std::string>(const std::string& module)> describe;
  };

  /// @param name  of the graph. Errors: System (another graph of this process has the name).
  static Result<std::unique_ptr<Observation>> make(Loop& loop, const std::string& name,
                                                   Asked asked);

  /// Publishes the state, if anybody reads it.
  void publish_state();
  /// Has the state published soon, however often it is called by then.
  void changed();
  void log(const std::string& line);
  [[nodiscard]] bool is_heard() const { return announcer_->is_heard(); }

 private:
  Observation(Loop& loop, Asked asked) : loop_(loop), asked_(std::move(asked)) {}

  Message state_message();
  void take_commands(const Message& message) const;

  Loop& loop_;
  Asked asked_;
  std::int64_t states_ = 0, lines_ = 0;  // published so far
  Loop::Handle soon_;
  std::unique_ptr<Announcer> announcer_;
  std::unique_ptr<Intake> commands_;
};

}  // namespace hc::internal
