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
  auto& process = process_.process();
  const auto usage = [&] { return process.usage(false); };
  liveness_.check(process.runs(), time, usage);
  if (!process.runs()) return;
  note_health(liveness_.health(limits_.stall, time, usage));
  kill_if_hung();
}

void Supervised::note_health(Health health) {
  const bool is_stalled = status_ == ModuleStatus::Stalled;
  if (!is_stalled && status_ != ModuleStatus::Running && status_ != ModuleStatus::Starting) return;
  const bool stalls = health == Health::Busy || health == Health::Stopped;
  if (stalls == is_stalled && health != Health::Blocked) return;
  if (stalls) {
    change(ModuleStatus::Stalled, health == Health::Stopped ? "stopped by a signal" : "busy");
    callbacks_.event(Level::Warning, "unresponsive: " + detail_);
  } else {
    if (is_stalled) callbacks_.event(Level::Info, "resumed");
    const auto output = reports_.blocked_output();
    const bool is_starting = takes_commands() && !liveness_.has_reported();
    change(is_starting ? ModuleStatus::Starting : ModuleStatus::Running,
           health == Health::Blocked
               ? "blocked: " + (output.empty() ? "" : "output " + output + " ") +
                     "waits for its reader"
               : "");
  }
  if (!liveness_.has_reported()) liveness_.excuse();
}

void Supervised::kill_if_hung() {
  if (!hung_.empty() || status_ == ModuleStatus::Stopping) return;
  const auto first = takes_commands() ? std::optional(limits_.first_report) : std::nullopt;
  const auto patience =
      liveness_.hung_after(plan_.hang, first, [this] { return process_.process().usage(false); });
  if (!patience) return;
  const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(*patience).count();
  hung_ = "hung for " + std::to_string(seconds) + " s";
  process_.process().kill();
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
