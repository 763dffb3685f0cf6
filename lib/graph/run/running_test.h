// SPDX-License-Identifier: Apache-2.0
#pragma once
// Shared by the tests of running graphs: a graph of shells, and its log. Internal.

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include <graph/run.h>
#include <hc/os/event.h>
#include <hc/testing/must.h>

namespace hc {

inline std::string peer_of(const std::string& listening) {
  return "unix" + listening.substr(listening.find(':'));
}

/// A graph of shells, each with its script; the log is in `lines_`.
class Run : public ::testing::Test {
 protected:
  PlannedModule& add(const std::string& name, const std::string& script) {
    PlannedModule module;
    module.name = name;
    module.program = "/bin/sh";
    module.options = {"-c", script};
    module.restart = Restart::Never;
    module.manage_uri = "unix-listen:@" + token_ + "." + name + ".manage";
    plan_.modules.push_back(std::move(module));
    return plan_.modules.back();
  }

  Result<RunReport> run() {
    options_.stop = stop_.descriptor();
    options_.event = [this](const LogLine& event) {
      const std::string line = event.line();
      lines_.emplace_back(line);
      if (line == stop_at_ && count(line) == stop_at_count_) stop();
      if (on_line_) on_line_(line);
    };
    return run_graph(loaded(plan_), options_);
  }

  /// A plan as if it had been loaded from `files_`.
  LoadedGraph loaded(const Plan& plan) const {
    LoadedGraph loaded{{}, plan, {}, {}};
    loaded.graph.files = files_;
    for (const auto& module : plan.modules) {
      loaded.graph.modules.emplace_back().name = module.name;
      for (const auto& [key, value] : module.parameters)
        loaded.graph.modules.back().parameters[key] = {value, {}};
    }
    return loaded;
  }

  void stop() const { stop_.raise(); }
  /// Stops the graph when a line has been logged this many times.
  void stop_at(const std::string& line, int times = 1) {
    stop_at_ = line;
    stop_at_count_ = times;
  }

  bool logged(const std::string& line) const { return count(line) > 0; }
  std::ptrdiff_t count(const std::string& line) const {
    return std::count(lines_.begin(), lines_.end(), line);
  }

  std::string token_ = graph_token();
  Plan plan_;
  std::vector<std::string> files_;
  RunOptions options_;
  std::function<void(std::string_view line)> on_line_;
  std::string stop_at_;
  int stop_at_count_ = 1;
  Event stop_ = must(Event::make());
  std::vector<std::string> lines_;
};

}  // namespace hc
