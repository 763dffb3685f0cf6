// SPDX-License-Identifier: Apache-2.0
#pragma once
// A graph at work: its modules, the links between them, and what others ask of it. Internal to
// graph.

#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <hc/graph/run.h>
#include <hc/graph/run/aside.h>
#include <hc/graph/run/observation.h>
#include <hc/graph/run/supervised.h>
#include <hc/os/file_watch.h>
#include <hc/os/loop.h>

namespace hc::internal {

class Runner {
 public:
  Runner(Plan plan, const RunOptions& options) : options_(options), plan_(std::move(plan)) {}

  Result<RunReport> run();

 private:
  using LinkName = std::pair<std::string, std::string>;  // from, to
  struct Failure {
    std::string module;
    int status;
  };
  struct Change {                       // that is wanted
    std::vector<std::string> commands;  // none: a file was edited
    Observation::Answer answer;
  };
  struct Planned {
    std::vector<std::string> edits;
    Replanned changed;
    std::optional<Replanned> alone;  // without the edits, where the files may be right
  };

  Status begin();
  Result<std::unique_ptr<Supervised>> make(const PlannedModule& module);
  [[nodiscard]] Supervised* find(const std::string& name) const;
  /// The module of "MODULE.PORT"; null where it is the world outside.
  [[nodiscard]] Supervised* at(const std::string& end) const;

  void tell(const std::string& line) const;
  void say(const std::string& line);
  void hear(std::string line);
  [[nodiscard]] std::string with_link_names(std::string line) const;

  void tick();
  void settle();
  void settle_failures();
  void settle_links();
  void end_unneeded();
  void end_all();
  [[nodiscard]] bool is_over() const;

  void read_anew();
  void obey(const std::vector<std::string>& lines, Observation::Answer answer);
  Result<std::string> observe(const std::string& port);
  void carry_out(const std::vector<std::string>& lines);
  void plan_next();
  void take_planned(Planned& planned);
  void take_edit(Planned& planned);
  void refuse_changes();
  void read_what_ends(const Plan& next);
  void change_to(Plan plan);
  void add(const PlannedModule& module);

  [[nodiscard]] GraphState state() const;
  [[nodiscard]] LinkState state_of(const PlannedLink& link) const;

  static constexpr std::size_t kMaxResults = 100;

  const RunOptions& options_;
  Plan plan_;
  MonotonicTime begun_{0};
  int ticks_ = 0;
  bool is_stopping_ = false, is_stopped_ = false;
  bool is_file_gone_ = false;  // the graph's own
  bool is_unsettled_ = false;  // a module has started or ended, or links have changed
  std::vector<Failure> failures_;
  std::vector<std::string> results_;  // lines
  Status outcome_;
  std::vector<std::string> commands_;    // that have changed the graph
  std::deque<Change> changes_;           // the first of them is being planned
  std::map<std::string, int> observed_;  // outputs that have been observed, and their numbers
  std::unique_ptr<Loop> loop_;
  std::unique_ptr<Observation> observation_;
  std::unique_ptr<FileWatch> files_;
  std::unique_ptr<Aside> planning_;
  std::map<LinkName, std::unique_ptr<Intake>>
      stand_ins_;                                // for readers that are over; null: failed
  std::vector<std::unique_ptr<Intake>> ending_;  // read links that are taken away
  std::map<std::string, std::unique_ptr<Supervised>> modules_, leaving_;  // by name
  Loop::Handle stop_, tick_;
};

}  // namespace hc::internal
