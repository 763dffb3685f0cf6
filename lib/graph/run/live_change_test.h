// SPDX-License-Identifier: Apache-2.0
#pragma once
// Shared by tests that change a running graph.

#include <poll.h>

#include <atomic>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <graph/run/running_test.h>
#include <hc/link/link.h>
#include <hc/mtp/rows.h>

namespace hc {

using Lines = std::vector<std::string>;

/// A running graph whose loader returns the plan set by plan_next().
class LiveChange : public Run, private GraphLoader {
 protected:
  LiveChange() {
    options_.name = "live";
    options_.loader = this;
  }

  PlannedModule& add(const std::string& name, const std::string& script = "exec sleep 1000") {
    auto& module = Run::add(name, script);
    module.restart = Restart::Failure;
    module.control_uri = "unix-listen:@" + token_ + "." + name + ".control";
    module.options = {"-c", script + "; # "};
    return module;
  }

  static std::map<std::string, ParameterState> rate() {
    ParameterState state;
    state.name = "rate";
    state.value = 30.0;
    return {{"rate", state}};
  }

  /// Sends commands to the running graph; returns its answer.
  static Lines ask(const Lines& commands, const std::string& name = "answer") {
    // A unique name: a process forked meanwhile may keep the last socket open for a moment.
    static std::atomic<int> calls = 0;
    const std::string place =
        "@live-" + name + "-" + std::to_string(::getpid()) + "-" + std::to_string(++calls);
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

  /// Calls a function on another thread, then stops the graph.
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
  /// Changes the graph to a plan, by a command whose effect the loader ignores.
  void change_to(const Plan& next) {
    plan_next(next);
    EXPECT_EQ(ask({"add x p"}), Lines{"ok"});
  }
  bool was_reloaded() {
    std::lock_guard lock(mutex_);
    return was_reloaded_;
  }

  std::function<void(int stop)> plans_;  // called while planning
  std::thread thread_;

 private:
  Result<LoadedGraph> load(const Plan*, int stop) override {
    auto next = plan({}, {}, stop);
    std::lock_guard lock(mutex_);
    was_reloaded_ = true;
    return next;
  }
  LoadedGraph plan(Graph, const Plan&, int stop) override {
    if (plans_) plans_(stop);
    std::lock_guard lock(mutex_);
    was_reloaded_ = false;
    LoadedGraph next = loaded(next_.value_or(Plan()));
    if (!next_) {
      next.plan.reset();
      next.problems = {"one problem", "another"};
    }
    return next;
  }

  std::mutex mutex_;
  std::optional<Plan> next_;
  bool was_reloaded_ = false;
};

/// Blocks until `stop` is readable.
inline void await(int stop) {
  pollfd polled{stop, POLLIN, 0};
  HC_CHECK(::poll(&polled, 1, -1) == 1, "poll");
}

}  // namespace hc
