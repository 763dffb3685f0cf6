// SPDX-License-Identifier: Apache-2.0
#pragma once
// A graph that runs and is changed, for tests: what it is told, and what it is planned anew as.

#include <poll.h>

#include <atomic>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <hc/graph/run/running_test.h>
#include <hc/mtp/rows.h>

namespace hc {

using Lines = std::vector<std::string>;

inline std::string peer_of(const std::string& listening) {
  return "unix" + listening.substr(listening.find(':'));
}

/// A graph that is planned anew when it is asked to be, by the name that a test gave it.
class LiveChange : public Run {
 protected:
  LiveChange() {
    options_.name = "live";
    options_.replan = [this](Reading reading, const Lines& commands, const Plan&, int stop) {
      if (plans_) plans_(commands, stop);
      std::lock_guard lock(mutex_);
      commands_ = commands;
      reading_ = reading;
      Replanned planned;
      if (next_)
        planned.plan = *next_;
      else
        planned.problems = {"one problem", "another"};
      return planned;
    };
  }

  PlannedModule& add(const std::string& name, const std::string& script = "exec sleep 1000") {
    auto& module = Run::add(name, script);
    module.restart = Restart::Failure;
    module.control_uri = "unix-listen:@" + token_ + "." + name + ".control";
    module.options = {"-c", script + "; # "};
    return module;
  }

  /// Asks the graph that runs; gives its answer.
  static Lines ask(const Lines& commands, const std::string& who = "answer") {
    // A process that is being forked beside this may hold the socket of the last call for a moment.
    static std::atomic<int> calls = 0;
    const std::string place =
        "@live-" + who + "-" + std::to_string(::getpid()) + "-" + std::to_string(++calls);
    auto answers = open_source({"unix-listen", place, {}});
    HC_CHECK(answers, answers.error().detail);
    Lines rows = {"reply unix:" + place};
    rows.insert(rows.end(), commands.begin(), commands.end());
    auto graph = open_sink(
        {"unix", "@hypercolumn.live." + std::to_string(::getpid()) + ".ask", {{"wait", "60"}}});
    HC_CHECK(graph, graph.error().detail);
    HC_CHECK((*graph)->send(make_rows(rows)));
    Message answer;
    HC_CHECK(receive(**answers, answer));
    return rows_of(answer);
  }

  /// Does something beside the graph, and ends it then.
  void beside(std::function<void()> what) {
    thread_ = std::thread([this, what = std::move(what)] {
      what();
      stop();
    });
  }

  Result<RunReport> run() {
    auto report = Run::run();
    if (thread_.joinable()) thread_.join();
    return report;
  }

  void plan_next(Plan plan) {
    std::lock_guard lock(mutex_);
    next_ = std::move(plan);
  }
  Lines commands() {
    std::lock_guard lock(mutex_);
    return commands_;
  }
  Reading reading() {
    std::lock_guard lock(mutex_);
    return reading_;
  }

  std::function<void(const Lines& commands, int stop)> plans_;  // hears that it is planned
  std::thread thread_;                                          // reads what the graph is made of

 private:
  std::mutex mutex_;
  std::optional<Plan> next_;
  Lines commands_;
  Reading reading_ = Reading::Anew;
};

/// Waits until somebody does not want to wait any more.
inline void await(int stop) {
  pollfd polled{stop, POLLIN, 0};
  HC_CHECK(::poll(&polled, 1, -1) == 1, "poll");
}

}  // namespace hc
