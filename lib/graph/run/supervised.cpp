// SPDX-License-Identifier: Apache-2.0
// Starts, restarts, ends and commands a module.
#include <graph/run/supervised.h>

#include <array>
#include <cmath>
#include <csignal>
#include <cstdio>

#include <graph/process.h>
#include <hc/base/check.h>
#include <hc/mtp/rows.h>

namespace hc::internal {
namespace {

using MonotonicClock = std::chrono::steady_clock;
using Verb = ModuleCommand::Verb;

constexpr int kCutOff = 1;                             // counts as a failure for restarts
constexpr std::chrono::milliseconds kCauseDelay{200};  // for the cause of an end to appear

std::string seconds_in_words(std::chrono::nanoseconds time) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2g s", std::chrono::duration<double>(time).count());
  return text;
}

Message message_of(const ModuleCommand& command) {
  return make_rows(std::array{text(command)});
}

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
      known_(plan_),
      limits_(limits),
      callbacks_(std::move(callbacks)),
      hosts_(hosts),
      restarts_(plan_.restart, limits.restarts,
                static_cast<std::uint32_t>(std::hash<std::string>()(plan_.manage_uri))),
      reports_(plan_.ends) {}

Result<std::unique_ptr<Supervised>> Supervised::make(Loop& loop, PlannedModule plan,
                                                     const SupervisionLimits& limits,
                                                     Callbacks callbacks, Hosts* hosts) {
  std::unique_ptr<Supervised> module(
      new Supervised(loop, std::move(plan), limits, std::move(callbacks), hosts));
  HC_TRY(module->make_process());
  return module;
}

/// Makes the ModuleProcess on the host of the plan, unless it exists.
Status Supervised::make_process() {
  const auto there = host();
  HC_CHECK(there != nullptr || plan_.host.empty(), plan_.name, plan_.host);
  if (process_ && there == process_host_) return {};
  ModuleCallbacks callbacks{[this](std::string_view text) { return take_text(text); },
                            [this](const Message& report) { take_report(report); },
                            [this] { return catch_up(); },
                            [this](int status) { note_end(status); }};
  std::unique_ptr<ModuleProcess> made;
  if (there) {
    made = there->make_process(plan_, std::move(callbacks));
  } else {
    made = HC_TRY(make_process_here(loop_, plan_.manage_uri, hosts_ == nullptr ? -1 : hosts_->key(),
                                    std::move(callbacks)));
  }
  // The old one, on another host, may be the caller of this function.
  if (process_) loop_.post([before = std::shared_ptr(std::move(process_))] {});
  process_ = std::move(made);
  process_host_ = there;
  return {};
}

/// The commands for a process that has just connected: changes since its start.
std::vector<Message> Supervised::catch_up() {
  const auto change = change_between(known_, plan_);
  std::vector<Message> commands;
  auto add = [&](const ModuleCommand& command) { commands.push_back(message_of(command)); };
  for (const auto* some : {&change.unlinks, &change.outputs, &change.inputs})
    for (const auto& command : *some) add(command);
  for (const auto& input : finished_) add({Verb::Finish, true, input, {}});
  for (const auto& [port, observed] : observed_) add({Verb::Link, false, observed.end.text(), {}});
  if (wall_offset_.count() != 0)
    add({Verb::WallOffset, true, std::to_string(wall_offset_.count()), {}});
  update_known();
  return commands;
}

/// Notes that the process knows the plan. It keeps the URIs under which it knows its links.
void Supervised::update_known() {
  auto ends = std::exchange(known_, plan_).ends;
  for (auto& end : known_.ends)
    for (const auto& before : ends)
      if (is_same_end(end, before)) end.uri = before.uri;
}

void Supervised::change(ModuleStatus status, const std::string& detail) {
  if (status_ == status && detail_ == detail) return;
  status_ = status;
  detail_ = detail;
  if (is_over()) process_->release_names();
  callbacks_.changed();
}

std::shared_ptr<Host> Supervised::host() const {
  return hosts_ == nullptr || plan_.host.empty() ? nullptr : hosts_->find(plan_.host);
}

void Supervised::check_host() {
  const auto there = awaits_host_ ? host() : nullptr;
  if (there && there->state().is_connected) start_again();
}

/// Sends the clock offset to a module on another host.
void Supervised::send_wall_offset() {
  constexpr std::chrono::microseconds kNear{20};
  const auto there = takes_commands() && process_->runs() ? process_host_ : nullptr;
  if (!there || !there->state().is_connected) return;
  const auto wall_offset = there->wall_offset();
  if (std::chrono::abs(wall_offset - wall_offset_) < kNear) return;
  wall_offset_ = wall_offset;
  if (process_->is_listening())
    send_commands({{Verb::WallOffset, true, std::to_string(wall_offset.count()), {}}});
}

Status Supervised::start() {
  timer_.reset();
  wish_ = Wish::None;
  HC_TRY(make_process());
  const auto& there = process_host_;
  awaits_host_ = there && !there->state().is_connected;
  if (awaits_host_) {
    change(ModuleStatus::Waiting, "host " + plan_.host + " is not connected");
    return {};
  }
  is_interrupted_ = awaits_cause_ = false;
  hung_.clear();
  finished_.clear();
  lines_.forget();
  restarts_.started(now());
  ++starts_;
  wall_offset_ = there && takes_commands() ? there->wall_offset() : std::chrono::nanoseconds(0);
  PlannedModule plan = plan_;
  // A workspace starts with the stops of its last process.
  if (const auto& stops = reports_.state().stops; !stops.empty() && plan.known.contains(kStops))
    plan.parameters.try_emplace(kStops, stops_text(stops));
  if (there && takes_commands())
    plan.add_option("--wall_offset", std::to_string(wall_offset_.count()));
  if (takes_commands() && callbacks_.is_graph_running()) plan.options.emplace_back("--join");
  if (auto started = process_->start(plan.command(), plan.control_uri); !started)
    return Error{started.error().code, plan_.name + ": " + started.error().detail};
  known_ = plan_;
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

void Supervised::end() {
  if (is_over()) return;
  wish_ = Wish::End;
  ask_to_end();
}

void Supervised::dismiss() {
  if (is_over()) return;
  wish_ = Wish::Dismissal;
  ask_to_end();
}

void Supervised::restart() {
  restarts_.reset();
  if (!process_->runs()) return start_again();
  wish_ = Wish::Restart;
  callbacks_.interrupted();
  ask_to_end();
}

/// Without a process, it ends at once.
void Supervised::ask_to_end() {
  if (!process_->runs()) {
    timer_.reset();
    awaits_cause_ = awaits_host_ = false;
    change(ModuleStatus::Ended);
    callbacks_.ended();
    return;
  }
  if (status_ == ModuleStatus::Stopping) return;
  process_->ask_to_end();
  change(ModuleStatus::Stopping);
  timer_ = loop_.call_at(MonotonicClock::now() + limits_.grace, [this] { process_->kill(); });
}

ModuleChange Supervised::adopt(PlannedModule plan) {
  // A connected process has all earlier commands. Another one catches up when it connects, so only
  // the difference between the plans is new.
  auto change = change_between(process_->is_listening() ? known_ : plan_, plan);
  const bool needs_restart = change_between(known_, plan).needs_restart;
  plan_ = std::move(plan);
  reports_.set_ends(plan_.ends);
  restarts_.set_policy(plan_.restart);
  if (change.is_empty() && !needs_restart) return {};
  // A module that has finished is restarted only for new inputs.
  const bool is_at_rest = status_ == ModuleStatus::Ended && change.inputs.empty();
  if (needs_restart || change.needs_restart || (!process_->runs() && !is_at_rest)) {
    restart();
    ModuleChange restarted;
    restarted.needs_restart = true;
    return restarted;
  }
  if (process_->is_listening()) update_known();
  for (const auto& command : change.outputs)
    if (command.verb == Verb::Set) callbacks_.event(Level::Info, text(command));
  return change;
}

void Supervised::send_commands(const std::vector<ModuleCommand>& commands) {
  for (const auto& command : commands) {
    if (!process_->is_listening() || wish_ == Wish::Restart || process_->send(message_of(command)))
      continue;
    callbacks_.event(Level::Warning, "does not accept commands; restarting");
    restart();
  }
}

void Supervised::finish_input(const PlannedEnd& end, bool is_finished) {
  const std::string what = end.text();
  if (is_finished && finished_.insert(what).second) send_commands({{Verb::Finish, true, what, {}}});
  if (!is_finished && finished_.erase(what) != 0) send_commands({{Verb::Link, true, what, {}}});
}

void Supervised::note_end(int status) {
  lines_.finish([this](const std::string& line) { take_line(Level::Info, line); });
  note_dropped_lines(now() + LogLimit::kPeriod);
  forget_process();
  handle_end(status);
}

void Supervised::forget_process() {
  reports_.end();
  reported_ = silence_ = blocked_ = MonotonicTime(0);
  timer_.reset();
  usage_ = {};
  measured_ = MonotonicTime(0);
  processor_ = 0;
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
  if (status != 0) callbacks_.failed(lines_.last());
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
    callbacks_.event(Level::Warning, words + "; restarting in " + seconds_in_words(decision.delay));
    change(ModuleStatus::Waiting, words);
    timer_ = loop_.call_at(MonotonicClock::now() + decision.delay, [this] { start_again(); });
    return;
  }
  bool is_given_up = decision.next == Next::GiveUp;
  callbacks_.event(is_given_up ? Level::Warning : Level::Info,
                   is_given_up && plan_.restart != Restart::Never
                       ? words + "; failed permanently" +
                             (starts_ > 1 ? " after " + std::to_string(starts_) + " starts" : "")
                       : words);
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
