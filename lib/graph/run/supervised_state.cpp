// SPDX-License-Identifier: Apache-2.0
// Observes a running module: its log, reports and usage.
#include <graph/run/supervised.h>

#include <algorithm>

#include <hc/base/visible.h>

namespace hc::internal {

void Supervised::note_dropped_lines(MonotonicTime time) {
  if (const auto remark = log_.take_remark(time); !remark.empty())
    callbacks_.event(Level::Warning, remark);
}

void Supervised::take_report(const Message& message) {
  const auto time = now();
  const bool has_changed = reports_.take(message, time);
  liveness_.reported(reports_.state().blocked_row != 0, time);
  if (message.header.src == static_cast<int>(Report::Log))
    if (const auto line = read_log(message)) log_.add(line->level, visible(line->text), time);
  if (status_ == ModuleStatus::Stalled) callbacks_.event(Level::Info, "resumed");
  if (status_ == ModuleStatus::Stalled || status_ == ModuleStatus::Starting ||
      status_ == ModuleStatus::Running)
    change(ModuleStatus::Running);
  if (has_changed) callbacks_.changed();
}

void Supervised::check(MonotonicTime time) {
  opened_.close_unused(liveness_.has_reported() ? &reports_ : nullptr, time);
  send(process_.correct_clock());
  note_dropped_lines(time);
  liveness_.check(process_.process().runs(), time);
  if (!process_.process().runs()) return;
  const bool is_silent = !liveness_.has_reported();
  if (is_silent) check_silent();
  const bool is_stalled = status_ == ModuleStatus::Stalled;
  const bool is_blocked = reports_.state().blocked_row != 0;
  if (kill_if_hung(is_blocked) || is_silent) return;
  if (status_ != ModuleStatus::Running && !(is_stalled && is_blocked)) return;
  if (liveness_.since_report(time) < limits_.stall) return;
  const bool is_stopped = process_.process().usage(false).is_stopped;
  if (is_blocked && !is_stopped) {
    if (is_stalled) callbacks_.event(Level::Info, "resumed");
    const auto output = reports_.blocked_output();
    return change(
        ModuleStatus::Running,
        "blocked: " + (output.empty() ? "" : "output " + output + " ") + "waits for its reader");
  }
  if (is_stalled) return;
  change(ModuleStatus::Stalled, is_stopped ? "stopped by a signal" : "busy");
  callbacks_.event(Level::Warning, "unresponsive: " + detail_);
}

/// Kills a process after `hang` without a report, or stopped by a signal; returns whether it did.
/// Spares a process in a debugger, and one that waits for a reader. The first report has more time,
/// for loading libraries.
bool Supervised::kill_if_hung(bool is_blocked) {
  if (!hung_.empty() || status_ == ModuleStatus::Stopping) return false;
  MonotonicTime patience = plan_.hang;
  if (patience == MonotonicTime(0) || liveness_.silence() < patience) return false;
  const auto usage = process_.process().usage(false);
  if (usage.is_traced || (is_blocked && !usage.is_stopped)) return false;
  if (!liveness_.has_reported() && !usage.is_stopped) {
    if (!takes_commands()) return false;  // it may never report
    patience = std::max(patience, limits_.first_report);
    if (liveness_.silence() < patience) return false;
  }
  hung_ = "hung for " +
          std::to_string(std::chrono::duration_cast<std::chrono::seconds>(patience).count()) + " s";
  process_.process().kill();
  return true;
}

/// Asks the kernel whether a module without reports is stopped by a signal.
void Supervised::check_silent() {
  const bool is_stalled = status_ == ModuleStatus::Stalled;
  const auto usual = takes_commands() ? ModuleStatus::Starting : ModuleStatus::Running;
  if (status_ != usual && !is_stalled) return;
  const bool is_stopped = process_.process().usage(false).is_stopped;
  if (is_stopped == is_stalled) return;
  liveness_.excuse();
  change(is_stopped ? ModuleStatus::Stalled : usual, is_stopped ? "stopped by a signal" : "");
  callbacks_.event(is_stopped ? Level::Warning : Level::Info,
                   is_stopped ? "unresponsive: " + detail_ : "resumed");
}

void Supervised::measure(MonotonicTime time, bool with_memory) {
  if (process_.process().runs()) meter_.measure(process_.process().usage(with_memory), time);
}

bool Supervised::waits_on(const PlannedLink& link) const {
  return liveness_.blocked_since() && reports_.is_blocked_on(link);
}

ModuleState Supervised::state() const {
  ModuleState state;
  state.name = plan_.name;
  state.program = plan_.program;
  state.group = plan_.group;
  state.host = plan_.host;
  state.process = process_.process().number();
  state.status = status_;
  state.detail = detail_;
  state.restarts = std::max(0, starts_ - 1);
  state.exit = exit_;
  state.processor = meter_.processor();
  state.memory = meter_.usage().memory;
  state.mode = plan_.mode;
  state.modes = plan_.modes;
  state.workspace = plan_.workspace;
  state.in_focus = reports_.state().in_focus;
  const auto time = now();
  if (const auto since = liveness_.blocked_since())
    state.waits = std::chrono::duration<double>(time - *since).count();
  log_.describe(state, time);
  state.parameters = plan_.parameters;
  for (const auto& [key, value] : reports_.parameters()) state.parameters[key] = value;
  return state;
}

}  // namespace hc::internal
