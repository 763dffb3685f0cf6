// SPDX-License-Identifier: Apache-2.0
// Observes a running module: its log, reports, usage and outputs.
#include <unistd.h>

#include <algorithm>

#include <graph/held_port.h>
#include <graph/run/supervised.h>
#include <hc/base/visible.h>

namespace hc::internal {
namespace {

constexpr int kMostResults = 100;  // never dropped; as many as are printed at the end
// Observers never make a module wait.
constexpr const char* kObserverPolicy = "?readers=0&stay=1&keep=16";

}  // namespace

Result<std::string> Supervised::observe(const std::string& port, const std::string& name) {
  auto found = observed_.find(port);
  if (found == observed_.end()) {
    Observed observed{{false, port, {}, {}}, {}};
    HC_TRY(open_observed(observed, name));
    found = observed_.emplace(port, std::move(observed)).first;
    send_commands({{ModuleCommand::Verb::Link, false, found->second.end.text(), {}}});
  }
  found->second.until = now() + kObserved;
  return found->second.uri;
}

/// Chooses the URIs of an output for observers. On another host, they use the key of this host.
Status Supervised::open_observed(Observed& observed, const std::string& name) {
  if (const auto there = host()) {
    observed.held = HC_TRY(there->spare_port());
    const auto number = ":" + std::to_string(observed.held->number);
    const auto place = there->place();
    const bool is_v6 = place.address.find(':') != std::string::npos;
    observed.end.uri = std::string("tls-listen:") + (is_v6 ? "[::]" : "0.0.0.0") + number +
                       kObserverPolicy + "&key=" + std::string(kKeyFile) +
                       "&peer=" + hosts_->fingerprint();
    observed.uri = "tls:" + (is_v6 ? "[" + place.address + "]" : place.address) + number +
                   "?key=/proc/" + std::to_string(::getpid()) + "/fd/" +
                   std::to_string(hosts_->key()) + "&peer=" + place.fingerprint;
    return {};
  }
  const bool has_memory = std::any_of(plan_.ends.begin(), plan_.ends.end(),
                                      [](const auto& end) { return end.uri.starts_with("shm:"); });
  observed.end.uri = (has_memory ? "shm:" : "unix-listen:@") + name + kObserverPolicy;
  observed.uri = (has_memory ? "shm:" : "unix:@") + name;
  return {};
}

void Supervised::end_observations(MonotonicTime time) {
  // While a process restarts, its readers wait for the next one.
  for (auto& [port, observed] : observed_)
    if (reported_ == MonotonicTime(0) || reports_.peers_of(observed.end) > 0)
      observed.until = time + kObserved;
  std::erase_if(observed_, [&](const auto& entry) {
    const bool is_over = time >= entry.second.until;
    if (is_over) send_commands({{ModuleCommand::Verb::Unlink, false, entry.second.end.text(), {}}});
    return is_over;
  });
}

bool Supervised::take_text(std::string_view text) {
  lines_.add(text, [this](const std::string& line) { take_line(Level::Info, line); });
  return !log_limit_.is_over();
}

void Supervised::take_line(Level level, std::string text) {
  // Modules prefix lines on standard error with their name.
  const std::string prefix = plan_.name + ": ";
  if (text.starts_with(prefix)) text.erase(0, prefix.size());
  const bool is_repeated = level == Level::Result || level == Level::Error;  // at the graph's end
  if (is_repeated) ++results_;
  const bool is_kept = is_repeated && results_ <= kMostResults;
  if (!is_kept && !log_limit_.passes(text.size(), now())) return;
  if (level != Level::Notice) {
    lines_.keep(text);
    last_level_ = level;
    last_line_time_ = now();
  }
  callbacks_.logged(level, text);
}

void Supervised::note_dropped_lines(MonotonicTime time) {
  if (const auto remark = log_limit_.take_remark(time); !remark.empty())
    callbacks_.event(Level::Warning, remark);
}

void Supervised::take_report(const Message& message) {
  reported_ = now();
  silence_ = MonotonicTime(0);
  const bool has_changed = reports_.take(message, reported_);
  const bool is_blocked = reports_.state().blocked_row != 0;
  if (!is_blocked) blocked_ = MonotonicTime(0);
  if (is_blocked && blocked_ == MonotonicTime(0)) blocked_ = reported_;
  if (message.header.src == static_cast<int>(Report::Log))
    if (const auto line = read_log(message)) take_line(line->level, visible(line->text));
  if (status_ == ModuleStatus::Stalled) callbacks_.event(Level::Info, "resumed");
  if (status_ == ModuleStatus::Stalled || status_ == ModuleStatus::Starting ||
      status_ == ModuleStatus::Running)
    change(ModuleStatus::Running);
  if (has_changed) callbacks_.changed();
}

void Supervised::check(MonotonicTime time) {
  constexpr MonotonicTime kMostAtOnce = std::chrono::seconds(1);
  end_observations(time);
  send_wall_offset();
  note_dropped_lines(time);
  // A gap between checks counts at most 1 s, as this process itself was stopped or starved.
  const auto before = std::exchange(checked_, time);
  if (!process_->runs()) return;
  if (before != MonotonicTime(0)) silence_ += std::min(time - before, kMostAtOnce);
  const bool is_silent = reported_ == MonotonicTime(0);
  if (is_silent) check_silent();
  const bool is_stalled = status_ == ModuleStatus::Stalled;
  const bool is_blocked = reports_.state().blocked_row != 0;
  if (kill_if_hung(is_blocked) || is_silent) return;
  if (status_ != ModuleStatus::Running && !(is_stalled && is_blocked)) return;
  if (time - reported_ < limits_.stall) return;
  const bool is_stopped = process_->usage(false).is_stopped;
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
  if (patience == MonotonicTime(0) || silence_ < patience) return false;
  const auto usage = process_->usage(false);
  if (usage.is_traced || (is_blocked && !usage.is_stopped)) return false;
  if (reported_ == MonotonicTime(0) && !usage.is_stopped) {
    if (!takes_commands()) return false;  // it may never report
    patience = std::max(patience, limits_.first_report);
    if (silence_ < patience) return false;
  }
  hung_ = "hung for " +
          std::to_string(std::chrono::duration_cast<std::chrono::seconds>(patience).count()) + " s";
  process_->kill();
  return true;
}

/// Asks the kernel whether a module without reports is stopped by a signal.
void Supervised::check_silent() {
  const bool is_stalled = status_ == ModuleStatus::Stalled;
  const auto usual = takes_commands() ? ModuleStatus::Starting : ModuleStatus::Running;
  if (status_ != usual && !is_stalled) return;
  const bool is_stopped = process_->usage(false).is_stopped;
  if (is_stopped == is_stalled) return;
  silence_ = MonotonicTime(0);
  change(is_stopped ? ModuleStatus::Stalled : usual, is_stopped ? "stopped by a signal" : "");
  callbacks_.event(is_stopped ? Level::Warning : Level::Info,
                   is_stopped ? "unresponsive: " + detail_ : "resumed");
}

void Supervised::measure(MonotonicTime time, bool with_memory) {
  if (!process_->runs()) return;
  const auto usage = process_->usage(with_memory);
  if (measured_ != MonotonicTime(0) && time > measured_)
    processor_ = std::max(0.0, std::chrono::duration<double>(usage.processor - usage_.processor) /
                                   std::chrono::duration<double>(time - measured_));
  usage_ = usage;
  measured_ = time;
}

bool Supervised::waits_on(const PlannedLink& link) const {
  return blocked_ != MonotonicTime(0) && reports_.is_blocked_on(link);
}

ModuleState Supervised::state() const {
  ModuleState state;
  state.name = plan_.name;
  state.program = plan_.program;
  state.group = plan_.group;
  state.host = plan_.host;
  state.process = process_->number();
  state.status = status_;
  state.detail = detail_;
  state.restarts = std::max(0, starts_ - 1);
  state.exit = exit_;
  state.processor = processor_;
  state.memory = usage_.memory;
  state.mode = plan_.mode;
  state.modes = plan_.modes;
  state.workspace = plan_.workspace;
  state.in_focus = reports_.state().in_focus;
  if (blocked_ != MonotonicTime(0))
    state.waits = std::chrono::duration<double>(now() - blocked_).count();
  if (!lines_.last().empty()) {
    state.last_line = lines_.last().back();
    state.last_level = last_level_;
    state.last_line_age = std::chrono::duration<double>(now() - last_line_time_).count();
  }
  state.parameters = plan_.parameters;
  for (const auto& [key, value] : reports_.parameters()) state.parameters[key] = value;
  return state;
}

}  // namespace hc::internal
