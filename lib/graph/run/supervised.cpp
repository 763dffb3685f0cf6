// SPDX-License-Identifier: Apache-2.0
// Starts, restarts, ends and commands a module.
#include <graph/run/supervised.h>

#include <cmath>
#include <csignal>

#include <graph/process.h>
#include <hc/base/format.h>

namespace hc::internal {
namespace {

using MonotonicClock = std::chrono::steady_clock;
using Verb = ModuleCommand::Verb;

constexpr int kCutOff = 1;                             // counts as a failure for restarts
constexpr std::chrono::milliseconds kCauseDelay{200};  // for the cause of an end to appear

}  // namespace

std::string end_in_words(int status) {
  if (status == 0) return "ended";
  if (status == Host::kHostLost) return "lost, with the connection to its host";
  if (status == Restarts::kBadArguments) return "failed with status 2 (bad arguments)";
  if (status > kSignal) return "killed by signal " + std::to_string(status - kSignal);
  return "failed with status " + std::to_string(status);
}

Supervised::Supervised(Loop& loop, PlannedModule plan, const SupervisionLimits& limits,
                       Callbacks callbacks, Hosts* hosts)
    : loop_(loop),
      plan_(std::move(plan)),
      limits_(limits),
      callbacks_(std::move(callbacks)),
      restarts_(plan_.restart, limits.restarts,
                static_cast<std::uint32_t>(std::hash<std::string>()(plan_.manage_uri))),
      log_(plan_.name, callbacks_.logged),
      reports_(plan_.ends),
      opened_(hosts, [this](const ModuleCommand& command) { send_commands({command}); }),
      process_(loop, hosts, plan_, opened_,
               {.wrote = [this](std::string_view text) { return log_.add(text, now()); },
                .reported = [this](const Message& report) { take_report(report); },
                .connected = {},
                .ended = [this](int status) { note_end(status); }}) {}

Result<std::unique_ptr<Supervised>> Supervised::make(Loop& loop, PlannedModule plan,
                                                     const SupervisionLimits& limits,
                                                     Callbacks callbacks, Hosts* hosts) {
  std::unique_ptr<Supervised> module(
      new Supervised(loop, std::move(plan), limits, std::move(callbacks), hosts));
  HC_TRY(module->process_.place());
  return module;
}

void Supervised::change(ModuleStatus status, const std::string& detail) {
  if (status_ == status && detail_ == detail) return;
  status_ = status;
  detail_ = detail;
  if (is_over()) process_.process().release_names();
  callbacks_.changed();
}

void Supervised::check_host() {
  if (awaits_host_ && process_.is_host_connected()) start_again();
}

Status Supervised::start() {
  timer_.reset();
  wish_ = Wish::None;
  HC_TRY(process_.place());
  awaits_host_ = !process_.is_host_connected();
  if (awaits_host_) {
    change(ModuleStatus::Waiting, "host " + plan_.host + " is not connected");
    return {};
  }
  is_interrupted_ = awaits_cause_ = false;
  hung_.clear();
  log_.forget_last();
  restarts_.started(now());
  ++starts_;
  PlannedModule plan = plan_;
  // A workspace starts with the stops of its last process.
  if (const auto& stops = reports_.state().stops; !stops.empty() && plan.known.contains(kStops))
    plan.parameters.try_emplace(kStops, stops_text(stops));
  if (takes_commands() && callbacks_.is_graph_running()) plan.options.emplace_back("--join");
  if (auto started = process_.start(std::move(plan)); !started)
    return Error{started.error().code, plan_.name + ": " + started.error().detail};
  callbacks_.event(Level::Info, "started");
  change(takes_commands() ? ModuleStatus::Starting : ModuleStatus::Running);
  return {};
}

void Supervised::start_again() {
  auto started = start();
  if (started) return;
  callbacks_.event(Level::Warning, started.error().detail);
  forget_process();
  handle_end(kCannotExecute);
}

void Supervised::end(Wish wish) {
  if (is_over()) return;
  wish_ = wish;
  ask_to_end();
}

void Supervised::restart() {
  restarts_.reset();
  if (!process_.process().runs()) return start_again();
  wish_ = Wish::Restart;
  callbacks_.interrupted();
  ask_to_end();
}

/// Without a process, it ends at once.
void Supervised::ask_to_end() {
  if (!process_.process().runs()) {
    timer_.reset();
    awaits_cause_ = awaits_host_ = false;
    change(ModuleStatus::Ended);
    callbacks_.ended();
    return;
  }
  if (status_ == ModuleStatus::Stopping) return;
  process_.process().ask_to_end();
  change(ModuleStatus::Stopping);
  timer_ =
      loop_.call_at(MonotonicClock::now() + limits_.grace, [this] { process_.process().kill(); });
}

ModuleChange Supervised::adopt(PlannedModule plan) {
  auto change = process_.change_to(plan);
  plan_ = std::move(plan);
  reports_.set_ends(plan_.ends);
  restarts_.set_policy(plan_.restart);
  if (change.is_empty()) return {};
  // A module that has finished is restarted only for new inputs.
  const bool is_at_rest = status_ == ModuleStatus::Ended && change.inputs.empty();
  if (change.needs_restart || (!process_.process().runs() && !is_at_rest)) {
    restart();
    ModuleChange restarted;
    restarted.needs_restart = true;
    return restarted;
  }
  process_.note_change();
  for (const auto& command : change.outputs)
    if (command.verb == Verb::Set) callbacks_.event(Level::Info, text(command));
  return change;
}

void Supervised::send_commands(const std::vector<ModuleCommand>& commands) {
  for (const auto& command : commands) {
    if (wish_ == Wish::Restart || process_.send(command)) continue;
    callbacks_.event(Level::Warning, "does not accept commands; restarting");
    restart();
  }
}

void Supervised::finish_input(const PlannedEnd& end, bool is_finished) {
  send(process_.finish_input(end, is_finished));
}

void Supervised::send(const std::optional<ModuleCommand>& command) {
  if (command) send_commands({*command});
}

void Supervised::note_end(int status) {
  log_.finish(now());
  note_dropped_lines(now() + LogLimit::kPeriod);
  forget_process();
  handle_end(status);
}

void Supervised::forget_process() {
  reports_.end();
  liveness_.forget();
  timer_.reset();
  meter_ = {};
}

/// Restarts or ends the module after its process has ended.
void Supervised::handle_end(int status) {
  exit_ = status;
  auto words = why_ended(status);
  // The signal may end a process before it has set a handler, which is not a failure.
  const bool is_as_asked = wish_ != Wish::None && (status == 0 || status == kSignal + SIGTERM);
  if (wish_ == Wish::End || wish_ == Wish::Restart || is_as_asked) {
    callbacks_.event(is_as_asked ? Level::Info : Level::Warning,
                     is_as_asked ? end_in_words(0) : words);
    if (wish_ == Wish::Restart) {
      callbacks_.interrupted();
      return start_again();
    }
    change(ModuleStatus::Ended);
    return callbacks_.ended();
  }
  if (status != 0) callbacks_.failed(log_.last());
  if (status == 0 && can_be_cut_off() && callbacks_.has_work()) {
    awaits_cause_ = true;
    change(ModuleStatus::Waiting, words);
    timer_ = loop_.call_at(MonotonicClock::now() + kCauseDelay, [this] { decide(0); });
    return;
  }
  decide(status);
}

/// Restarts a process that has ended by itself, or gives it up. Called at once, or by the timer if
/// the cause may be a link that was cut.
void Supervised::decide(int status) {
  awaits_cause_ = false;
  const auto words = why_ended(status);
  const bool is_cut_off = status == 0 && is_interrupted_ && callbacks_.has_work();
  const auto decision = status == Host::kHostLost
                            ? restarts_.lost(now())
                            : restarts_.ended(is_cut_off ? kCutOff : status, now());
  using Next = Restarts::Next;
  if (decision.next == Next::Again) callbacks_.interrupted();
  if (decision.next == Next::Again && decision.delay.count() == 0) {
    callbacks_.event(Level::Warning, words + "; restarting");
    return start_again();
  }
  if (decision.next == Next::Again) {
    callbacks_.event(Level::Warning,
                     words + hc::format("; restarting in {:.2g} s", seconds(decision.delay)));
    change(ModuleStatus::Waiting, words);
    timer_ = loop_.call_at(MonotonicClock::now() + decision.delay, [this] { start_again(); });
    return;
  }
  const bool is_given_up = decision.next == Next::GiveUp;
  auto text = words;
  if (is_given_up && plan_.restart != Restart::Never) {
    text += "; failed permanently";
    if (starts_ > 1) text += " after " + std::to_string(starts_) + " starts";
    text += "; hc graph restart " + plan_.name + " starts it again";
  }
  callbacks_.event(is_given_up ? Level::Warning : Level::Info, text);
  change(is_given_up ? ModuleStatus::GivenUp : ModuleStatus::Ended, is_given_up ? words : "");
  callbacks_.ended();
}

std::string Supervised::why_ended(int status) const {
  return hung_.empty() ? end_in_words(status) : hung_;
}

bool Supervised::can_be_cut_off() const {
  return plan_.control_uri.empty() && plan_.restart != Restart::Never;
}

void Supervised::note_interruption() {
  if (!can_be_cut_off()) return;
  is_interrupted_ = true;
  if (awaits_cause_) timer_.call_at(MonotonicClock::now());
}

}  // namespace hc::internal
