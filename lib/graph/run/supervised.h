// SPDX-License-Identifier: Apache-2.0
#pragma once
// One module of a graph that runs: its process, and the next one where that fails; what it says and
// reports; and the commands it gets. Internal to graph.

#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <graph/hosts.h>
#include <graph/log_limit.h>
#include <graph/module_process.h>
#include <graph/run/change.h>
#include <graph/run/lines.h>
#include <graph/run/reports.h>
#include <graph/run/restarts.h>
#include <hc/base/clock.h>
#include <hc/contract/graph_state.h>
#include <hc/os/procfs.h>

namespace hc::internal {

inline constexpr int kSignal = 128;  ///< the status of who was killed by one is above

inline MonotonicTime now() {
  return SystemClock().monotonic();
}

/// How a process has ended, by its status: "failed with status 1".
std::string end_in_words(int status);

class Supervised {
 public:
  /// Called when something happens to it. None may destroy it.
  struct Callbacks {
    std::function<void(Level level, const std::string& text)> event;  ///< "started"
    std::function<void(Level level, const std::string& text)> said;   ///< by the module itself
    std::function<void(const std::deque<std::string>& last_words)> failed;
    std::function<void()> changed;      ///< its state, other than in numbers
    std::function<void()> ended;        ///< for good
    std::function<void()> interrupted;  ///< its process ends, and another will follow
    std::function<bool()> has_work;     ///< a writer of its inputs is not over; of one without,
                                        ///< a reader
    std::function<bool()> is_graph_running;  ///< all its modules have run before
  };

  /// Listens to a module, which is not started yet. Errors: Invalid, System (a name is in use).
  /// @param hosts  that it may run on; null: this one alone.
  static Result<std::unique_ptr<Supervised>> make(Loop& loop, PlannedModule plan,
                                                  const SupervisionLimits& limits,
                                                  Callbacks callbacks, Hosts* hosts = nullptr);

  /// Starts it. Errors: System; of later starts they are events.
  Status start();
  /// Ends it for good: SIGTERM, and SIGKILL when it has had its time.
  void end();
  /// Ends it since nobody needs it any more. If it fails all the same, it has failed.
  void dismiss();
  /// Ends it where it runs, and starts it, also if it has failed permanently.
  void restart();

  /// Takes another plan, and restarts where commands cannot make it so. @returns  the commands for
  /// send_commands().
  ModuleChange adopt(PlannedModule plan);
  /// Sends commands. They reach a module that has not connected yet when it connects; one
  /// that accepts no commands is restarted.
  void send_commands(const std::vector<ModuleCommand>& commands);

  /// Sends it `finish` when an input's writer has ended for good, and `link` when there is one
  /// again; each once.
  void finish_input(const PlannedEnd& end, bool is_finished);
  /// A module that it is linked to is interrupted. One without `control` takes that for the end of
  /// its work, and is restarted when it ends.
  void note_interruption();
  /// Has it open an output for clients, under a name that no other link has. It is closed when no
  /// reader has been connected for kObserved.
  ///
  /// @returns  the URI that observers read. Errors: Closed (its host is not connected).
  Result<std::string> observe(const std::string& port, const std::string& name);
  static constexpr std::chrono::seconds kObserved{5};

  /// Starts it if it waits for its host, and that is there.
  void look_at_host();
  /// Looks whether it still reports.
  void look(MonotonicTime now);
  /// Takes stock of what its processes use.
  void measure(MonotonicTime now, bool with_memory);
  /// Looks whether its process has ended, without waiting for the event.
  void look_for_end() { process_->look(); }

  [[nodiscard]] const PlannedModule& plan() const { return plan_; }
  [[nodiscard]] ModuleStatus status() const { return status_; }
  /// Whether it runs, or has run.
  [[nodiscard]] bool has_run() const {
    return starts_ > 1 || status_ == ModuleStatus::Running || is_over();
  }
  [[nodiscard]] bool is_over() const {
    return status_ == ModuleStatus::Ended || status_ == ModuleStatus::GivenUp;
  }
  /// Ended or is about to, because it was asked to.
  [[nodiscard]] bool is_to_end() const { return wish_ == Wish::End || wish_ == Wish::Dismissal; }
  [[nodiscard]] std::optional<int> exit() const { return exit_; }
  [[nodiscard]] const Reports& reports() const { return reports_; }
  [[nodiscard]] ModuleState state() const;
  /// Whether a link is the one for whose reader it waits.
  [[nodiscard]] bool waits_on(const PlannedLink& link) const;

 private:
  Supervised(Loop& loop, PlannedModule plan, const SupervisionLimits& limits, Callbacks callbacks,
             Hosts* hosts);

  /// What its process has been asked to end for.
  enum class Wish { None, End, Restart, Dismissal };

  struct Observed {
    PlannedEnd end;
    std::string uri;  // for observers
    MonotonicTime until{0};
    std::shared_ptr<const HeldPort> held = {};  // where it is read from another host
  };

  [[nodiscard]] std::shared_ptr<Host> host() const;
  Status make_process();
  void send_wall_offset();
  Status open_observed(Observed& observed, const std::string& name);
  void end_observations(MonotonicTime time);
  std::vector<Message> catch_up();
  void set_told();
  [[nodiscard]] bool takes_commands() const { return !plan_.control_uri.empty(); }
  void change(ModuleStatus status, const std::string& detail = "");
  void ask_to_end();
  bool take_text(std::string_view text);
  void take_line(Level level, std::string text);
  void note_dropped_lines(MonotonicTime time);
  void take_report(const Message& message);
  void look_at_silent();
  bool kill_if_hung(bool is_blocked);
  void note_end(int status);
  void forget_process();
  void go_on(int status);
  void decide(int status);
  [[nodiscard]] bool can_be_cut_off() const;
  [[nodiscard]] std::string why_ended(int status) const;
  void start_again();

  Loop& loop_;
  PlannedModule plan_;
  PlannedModule told_;  // as its process knows it, which may know links by their older URIs
  SupervisionLimits limits_;
  Callbacks callbacks_;
  Hosts* hosts_;
  bool awaits_host_ = false;
  std::int64_t wall_offset_ = 0;  // as its process knows it, of another host [ns]
  ModuleStatus status_ = ModuleStatus::Waiting;
  std::string detail_;
  Wish wish_ = Wish::None;
  bool is_interrupted_ = false;  // a link has been cut that this process cannot mend
  bool awaits_cause_ = false;    // it has ended, perhaps since a link was cut
  std::optional<int> exit_;
  int starts_ = 0;
  Restarts restarts_;
  Lines lines_;
  LogLimit log_limit_;
  int results_ = 0;                 // and errors, among what it has said
  Level said_level_ = Level::Info;  // of the last line,
  MonotonicTime said_at_{0};        // and when it was said
  Reports reports_;
  MonotonicTime heard_{0};                // when this process reported last; 0: it has not
  MonotonicTime looked_{0}, silence_{0};  // the last look; without a sign, as far as one looked
  MonotonicTime blocked_{0};              // since when it waits for a reader; 0: it does not
  std::string hung_;  // why this process was killed: "hung for 5 s"; empty: it was not
  Usage usage_;
  MonotonicTime measured_{0};
  double processor_ = 0;
  std::set<std::string> finished_;            // inputs it has to finish
  std::map<std::string, Observed> observed_;  // by output
  std::shared_ptr<Host> process_host_;        // null: this one
  std::unique_ptr<ModuleProcess> process_;
  Loop::Handle timer_;
};

}  // namespace hc::internal
