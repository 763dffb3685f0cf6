// SPDX-License-Identifier: Apache-2.0
#pragma once
// Supervises one module of a running graph: its process and restarts, its log and reports, and its
// commands. Internal to graph.

#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <graph/hosts.h>
#include <graph/module_process.h>
#include <graph/run/change.h>
#include <graph/run/commanded_process.h>
#include <graph/run/liveness.h>
#include <graph/run/module_log.h>
#include <graph/run/opened_ports.h>
#include <graph/run/reports.h>
#include <graph/run/restarts.h>
#include <hc/base/clock.h>
#include <hc/contract/graph_state.h>

namespace hc::internal {

inline constexpr int kSignal = 128;  ///< plus a signal: status of a process killed by it

inline MonotonicTime now() {
  return SystemClock().monotonic();
}

/// A status in words, such as "failed with status 1".
std::string end_in_words(int status);

class Supervised {
 public:
  /// They must not destroy it.
  struct Callbacks {
    std::function<void(Level level, const std::string& text)> event;   ///< such as "started"
    std::function<void(Level level, const std::string& text)> logged;  ///< by the module itself
    std::function<void(const std::deque<std::string>& last_lines)> failed;
    std::function<void()> changed;           ///< its state, except for counters
    std::function<void()> ended;             ///< for good
    std::function<void()> interrupted;       ///< its process ends and will be restarted
    std::function<bool()> has_work;          ///< some writer of its inputs (a module without
                                             ///< writers: some reader) has not ended for good
    std::function<bool()> is_graph_running;  ///< all its modules have run before
  };

  /// Listens for a module's reports; does not start it. Errors: Invalid, System (a name is in use).
  /// @param hosts  null: it runs on this host.
  static Result<std::unique_ptr<Supervised>> make(Loop& loop, PlannedModule plan,
                                                  const SupervisionLimits& limits,
                                                  Callbacks callbacks, Hosts* hosts = nullptr);

  /// Starts it. Errors: System; those of restarts are events.
  Status start();
  /// Ends it for good: SIGTERM, then SIGKILL after the grace time.
  void end() { end(Wish::End); }
  /// Ends it because it is no longer needed. Unlike with end(), a failure then counts.
  void dismiss() { end(Wish::Dismissal); }
  /// Ends it if it runs, and starts it again, even after a permanent failure.
  void restart();

  /// Takes another plan, and restarts if commands are not enough. @returns  the commands for
  /// send_commands().
  ModuleChange adopt(PlannedModule plan);
  /// Sends commands. A module that has not connected yet gets them when it connects; one that does
  /// not read them is restarted.
  void send_commands(const std::vector<ModuleCommand>& commands);

  /// Sends it `finish` when an input's writer has ended for good, and `link` when it is started
  /// again; each once.
  void finish_input(const PlannedEnd& end, bool is_finished);
  /// Notes that a linked module is interrupted. A module without `control` ends then, as if its
  /// work were done, and is restarted.
  void note_interruption();
  /// Opens a port to programs outside the graph: see OpenedPorts::open().
  Result<std::string> open_port(bool is_input, const std::string& port, const std::string& name) {
    return opened_.open(plan_, is_input, port, name, now());
  }

  /// Starts it if it waits for its host, and the host is connected.
  void check_host();
  /// Checks for missing reports.
  void check(MonotonicTime now);
  /// Measures the CPU time and memory of its processes.
  void measure(MonotonicTime now, bool with_memory);
  /// Checks whether its process has ended, without waiting for the event.
  void check_end() { process_.process().check_end(); }

  [[nodiscard]] const PlannedModule& plan() const { return plan_; }
  [[nodiscard]] ModuleStatus status() const { return status_; }
  [[nodiscard]] bool has_run() const {
    return starts_ > 1 || status_ == ModuleStatus::Running || is_over();
  }
  [[nodiscard]] bool is_over() const {
    return status_ == ModuleStatus::Ended || status_ == ModuleStatus::GivenUp;
  }
  /// Has ended or will end on request.
  [[nodiscard]] bool is_to_end() const { return wish_ == Wish::End || wish_ == Wish::Dismissal; }
  [[nodiscard]] std::optional<int> exit() const { return exit_; }
  [[nodiscard]] const Reports& reports() const { return reports_; }
  [[nodiscard]] ModuleState state() const;
  /// Whether it waits for the reader of a link.
  [[nodiscard]] bool waits_on(const PlannedLink& link) const;

 private:
  Supervised(Loop& loop, PlannedModule plan, const SupervisionLimits& limits, Callbacks callbacks,
             Hosts* hosts);

  /// Why its process has been asked to end.
  enum class Wish { None, End, Restart, Dismissal };

  void send(const std::optional<ModuleCommand>& command);
  [[nodiscard]] bool takes_commands() const { return !plan_.control_uri.empty(); }
  void change(ModuleStatus status, const std::string& detail = "");
  void end(Wish wish);
  void ask_to_end();
  void note_dropped_lines(MonotonicTime time);
  void take_report(const Message& message);
  /// Shows why it is silent, or that it is not any more.
  void note_health(Health health);
  void kill_if_hung();
  void note_end(int status);
  void forget_process();
  void handle_end(int status);
  void decide(int status);
  [[nodiscard]] bool can_be_cut_off() const;
  [[nodiscard]] std::string why_ended(int status) const;
  void start_again();

  Loop& loop_;
  PlannedModule plan_;
  SupervisionLimits limits_;
  Callbacks callbacks_;
  bool awaits_host_ = false;
  ModuleStatus status_ = ModuleStatus::Waiting;
  std::string detail_;
  Wish wish_ = Wish::None;
  bool is_interrupted_ = false;  // a link was cut that this process cannot restore
  bool awaits_cause_ = false;    // it has ended, perhaps because a link was cut
  std::optional<int> exit_;
  int starts_ = 0;
  Restarts restarts_;
  ModuleLog log_;
  Reports reports_;
  Liveness liveness_;
  std::string hung_;  // why this process was killed, "hung for 5 s"; empty: it was not
  ProcessorMeter meter_;
  OpenedPorts opened_;
  CommandedProcess process_;
  Loop::Handle timer_;
};

}  // namespace hc::internal
