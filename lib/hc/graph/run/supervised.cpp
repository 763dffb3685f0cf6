// SPDX-License-Identifier: Apache-2.0
#include <hc/graph/run/supervised.h>

#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdio>

#include <hc/contract/command.h>
#include <hc/mtp/rows.h>

namespace hc::internal {
namespace {

using MonotonicClock = std::chrono::steady_clock;

constexpr std::size_t kPiece = std::size_t{64} << 10;  // a pipe holds as much
constexpr int kLastPieces = 16;  // a pipe can be made to hold a MiB; source: man 7 pipe
constexpr int kCutOff = 1;       // a failure, as far as restarts go
constexpr std::chrono::milliseconds kCauseDelay{200};  // until the cause of an end is seen, at most
// Observers never make a module wait: with or without one, it keeps a few messages for them.
constexpr const char* kObserverPolicy = "?readers=0&stay=1&keep=16";
constexpr std::uint64_t kMostReported = std::uint64_t{1} << 20;  // in one message [byte]

std::string seconds_in_words(std::chrono::nanoseconds time) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2g s", std::chrono::duration<double>(time).count());
  return text;
}

Message command_message(const std::string& command) {
  return make_rows(std::array{command});
}

}  // namespace

std::string end_in_words(int status) {
  if (status == 0) return "ended";
  if (status > kSignal) return "killed by signal " + std::to_string(status - kSignal);
  return "failed with status " + std::to_string(status);
}

Supervised::Supervised(Loop& loop, PlannedModule plan, const SupervisionLimits& limits, Hear hear)
    : loop_(loop),
      plan_(std::move(plan)),
      told_(plan_),
      limits_(limits),
      hear_(std::move(hear)),
      restarts_(plan_.restart, limits.restarts,
                static_cast<std::uint32_t>(std::hash<std::string>()(plan_.manage_uri))),
      reports_(plan_.ends) {}

Result<std::unique_ptr<Supervised>> Supervised::make(Loop& loop, PlannedModule plan,
                                                     const SupervisionLimits& limits, Hear hear) {
  std::unique_ptr<Supervised> module(
      new Supervised(loop, std::move(plan), limits, std::move(hear)));
  auto& self = *module;
  LinkOptions options;
  options.limits.element_bytes = kMostReported;
  auto manage = Intake::make(
      loop, self.plan_.manage_uri, [&self](const Message& message) { self.take_report(message); },
      options);
  if (!manage) return manage.error();
  self.manage_ = std::move(*manage);
  if (auto opened = self.open_control(); !opened) return opened.error();
  return module;
}

/// Listens to be told, if the plan says that the module takes commands.
Status Supervised::open_control() {
  if (plan_.control_uri.empty()) control_.reset();
  if (plan_.control_uri.empty() || control_) return {};
  auto control = Announcer::make(loop_, plan_.control_uri, [this] {
    std::vector<Message> messages;
    for (const auto& command : catch_up()) messages.push_back(command_message(command));
    return messages;
  });
  if (!control) return control.error();
  control_ = std::move(*control);
  return {};
}

/// What a process that comes to listen has to be told: what has changed since it was started.
std::vector<std::string> Supervised::catch_up() {
  const auto change = change_between(told_, plan_);
  std::vector<std::string> commands;
  for (const auto* some : {&change.unlinks, &change.outputs, &change.inputs})
    commands.insert(commands.end(), some->begin(), some->end());
  for (const auto& input : finished_)
    commands.push_back(text({ModuleCommand::Verb::Finish, true, input, {}}));
  for (const auto& [port, observed] : observed_) commands.push_back(observed.command());
  set_told();
  return commands;
}

/// Notes that the process has been told all that the plan says. It goes on to know links by the
/// URIs that it has them by.
void Supervised::set_told() {
  auto ends = std::exchange(told_, plan_).ends;
  for (auto& end : told_.ends)
    for (const auto& before : ends)
      if (is_same_end(end, before)) end.uri = before.uri;
}

void Supervised::change(ModuleStatus status, const std::string& detail) {
  if (status_ == status && detail_ == detail) return;
  status_ = status;
  detail_ = detail;
  hear_.changed();
}

Status Supervised::start() {
  timer_.reset();
  wish_ = Wish::None;
  is_interrupted_ = awaits_cause_ = false;
  finished_.clear();
  lines_.forget();
  if (auto opened = open_control(); !opened) return opened;
  restarts_.started(now());
  ++starts_;
  auto process = Process::start(plan_.command(), Process::Capture::Errors);
  if (!process) return Error{process.error().code, plan_.name + ": " + process.error().detail};
  process_.emplace(std::move(*process));
  program_ = first_child(process_->guard_number());
  told_ = plan_;
  auto said = loop_.watch(process_->output(), EPOLLIN, [this](auto) { read_lines(); });
  if (!said) return said.error();
  said_ = std::move(*said);
  auto ended = loop_.watch(process_->ended(), EPOLLIN, [this](auto) { note_end(); });
  if (!ended) return ended.error();
  ended_ = std::move(*ended);
  hear_.event("started");
  change(control_ ? ModuleStatus::Starting : ModuleStatus::Running);
  return {};
}

void Supervised::start_again() {
  auto started = start();
  if (started) return;
  hear_.event(started.error().detail);
  forget_process();
  go_on(kCannotExecute);
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
  if (!process_) return start_again();
  wish_ = Wish::Restart;
  hear_.interrupted();
  ask_to_end();
}

/// Of one without a process, what follows its end follows at once.
void Supervised::ask_to_end() {
  if (!process_) {
    timer_.reset();
    awaits_cause_ = false;
    change(ModuleStatus::Ended);
    hear_.ended();
    return;
  }
  if (status_ == ModuleStatus::Stopping) return;
  process_->ask_to_end();
  change(ModuleStatus::Stopping);
  timer_ = loop_.call_at(MonotonicClock::now() + limits_.grace, [this] { process_->kill(); });
}

ModuleChange Supervised::adopt(PlannedModule plan) {
  // A connected one has been told all so far; another catches up, and only this plan's part is new.
  auto change = change_between(is_heard() ? told_ : plan_, plan);
  const bool needs_restart = change_between(told_, plan).needs_restart;
  plan_ = std::move(plan);
  reports_.set_ends(plan_.ends);
  restarts_.set_policy(plan_.restart);
  if (change.is_empty() && !needs_restart) return {};
  // One that has done its work has more to do when it has something else to read.
  const bool is_at_rest = status_ == ModuleStatus::Ended && change.inputs.empty();
  if (needs_restart || change.needs_restart || (!process_ && !is_at_rest)) {
    restart();
    ModuleChange restarted;
    restarted.needs_restart = true;
    return restarted;
  }
  if (is_heard()) set_told();
  for (const auto& command : change.outputs)
    if (command.starts_with("set ")) hear_.event(command);
  return change;
}

bool Supervised::is_heard() const {
  return process_ && control_ && control_->is_heard();
}

void Supervised::tell(const std::vector<std::string>& commands) {
  for (const auto& command : commands) {
    if (!is_heard() || wish_ == Wish::Restart || control_->say(command_message(command))) continue;
    hear_.event("does not accept commands; restarting");
    restart();
  }
}

void Supervised::finish_input(const PlannedEnd& end, bool is_finished) {
  std::string what = end.port + "=" + end.uri;
  if (is_finished && finished_.insert(what).second)
    tell({text({ModuleCommand::Verb::Finish, true, what, {}})});
  if (!is_finished && finished_.erase(what) != 0)
    tell({text({ModuleCommand::Verb::Link, true, what, {}})});
}

std::string Supervised::observe(const std::string& port, const std::string& name) {
  const bool has_memory = std::any_of(plan_.ends.begin(), plan_.ends.end(),
                                      [](const auto& end) { return end.uri.starts_with("shm:"); });
  auto [found, is_new] = observed_.try_emplace(port);
  auto& observed = found->second;
  if (is_new) {
    observed.text = port + (has_memory ? "=shm:" : "=unix-listen:@") + name + kObserverPolicy;
    observed.uri = (has_memory ? "shm:" : "unix:@") + name;
    tell({observed.command()});
  }
  observed.until = now() + kObserved;
  return observed.uri;
}

void Supervised::end_observations(MonotonicTime time) {
  std::erase_if(observed_, [&](const auto& entry) {
    const bool is_over = time >= entry.second.until;
    if (is_over) tell({"unlink out " + entry.second.text});
    return is_over;
  });
}

/// Hands on what a module has said, until it says nothing more. One piece only: one who does not
/// stop must not keep us from all else.
void Supervised::read_lines() {
  static thread_local std::array<char, kPiece> piece;
  const ssize_t size = ::read(process_->output(), piece.data(), piece.size());
  if (size == 0) said_.reset();
  if (size <= 0) return;
  lines_.add({piece.data(), static_cast<std::size_t>(size)}, hear_.said);
  said_at_ = now();
}

void Supervised::take_report(const Message& message) {
  heard_ = now();
  const bool has_changed = reports_.take(message, heard_);
  if (message.header.src == static_cast<int>(Report::Refusal) &&
      message.header.info.type == MatrixType::String)
    for (const auto& line : rows_of(message)) hear_.event(line);
  if (status_ == ModuleStatus::Stalled) hear_.event("resumed");
  if (status_ == ModuleStatus::Stalled || status_ == ModuleStatus::Starting ||
      status_ == ModuleStatus::Running)
    change(ModuleStatus::Running);
  if (has_changed) hear_.changed();
}

void Supervised::look(MonotonicTime time) {
  end_observations(time);
  const bool is_stalled = status_ == ModuleStatus::Stalled;
  const bool is_blocked = reports_.state().blocked_row != 0;
  if (status_ != ModuleStatus::Running && !(is_stalled && is_blocked)) return;
  if (heard_ == MonotonicTime(0) || time - heard_ < limits_.stall) return;
  const bool is_stopped = usage_of(descendants(process_->guard_number()), false).is_stopped;
  if (is_blocked && !is_stopped) {
    if (is_stalled) hear_.event("resumed");
    const auto output = reports_.blocked_output();
    return change(ModuleStatus::Running,
                  "blocked: no reader" + (output.empty() ? "" : " on output " + output));
  }
  if (is_stalled) return;
  change(ModuleStatus::Stalled, is_stopped ? "stopped by a signal" : "busy");
  hear_.event("unresponsive: " + detail_);
}

void Supervised::measure(MonotonicTime time, bool with_memory) {
  if (!process_) return;
  with_memory = with_memory || processes_.empty();
  if (with_memory) processes_ = descendants(process_->guard_number());
  auto usage = usage_of(processes_, with_memory);
  if (!with_memory) usage.memory = usage_.memory;
  if (measured_ != MonotonicTime(0) && time > measured_)
    processor_ = std::max(0.0, std::chrono::duration<double>(usage.processor - usage_.processor) /
                                   std::chrono::duration<double>(time - measured_));
  usage_ = usage;
  measured_ = time;
}

void Supervised::note_end() {
  if (!process_) return;
  auto status = process_->poll_status();
  if (!status) return;
  manage_->take();  // lets in one that has just come,
  manage_->take();  // … and hears what it had to say
  // Its last words stand in the pipe; who else still holds that open may do so for ever.
  for (int piece = 0; piece < kLastPieces && said_; ++piece) read_lines();
  lines_.finish(hear_.said);
  forget_process();
  go_on(*status);
}

void Supervised::forget_process() {
  reports_.end();
  heard_ = MonotonicTime(0);
  said_.reset();
  ended_.reset();
  timer_.reset();
  process_.reset();
  program_ = 0;
  processes_.clear();
  usage_ = {};
  measured_ = MonotonicTime(0);
  processor_ = 0;
  if (control_) control_->leave_all();
}

/// Does what is to be done when a process has ended.
void Supervised::go_on(int status) {
  exit_ = status;
  auto words = end_in_words(status);
  // One that did not come to heed our signal yet has done as it was told all the same.
  const bool is_as_told = wish_ != Wish::None && (status == 0 || status == kSignal + SIGTERM);
  if (wish_ == Wish::End || wish_ == Wish::Restart || is_as_told) {
    hear_.event(is_as_told ? end_in_words(0) : words);
    if (wish_ == Wish::Restart) {
      hear_.interrupted();
      return start_again();
    }
    change(ModuleStatus::Ended);
    return hear_.ended();
  }
  if (status != 0) hear_.failed(lines_.last());
  if (status == 0 && can_be_cut_off() && hear_.has_work()) {
    awaits_cause_ = true;
    change(ModuleStatus::Waiting, words);
    timer_ = loop_.call_at(MonotonicClock::now() + kCauseDelay, [this] { decide(0); });
    return;
  }
  decide(status);
}

/// Restarts a process that has ended by itself, or gives it up.
void Supervised::decide(int status) {
  awaits_cause_ = false;
  const auto words = end_in_words(status);
  const bool is_cut_off = status == 0 && is_interrupted_ && hear_.has_work();
  auto decision = restarts_.ended(is_cut_off ? kCutOff : status, now());
  using Next = Restarts::Next;
  if (decision.next == Next::Again) hear_.interrupted();
  if (decision.next == Next::Again && decision.delay.count() == 0) {
    hear_.event(words + "; restarting");
    return start_again();
  }
  if (decision.next == Next::Again) {
    hear_.event(words + "; restarting in " + seconds_in_words(decision.delay));
    change(ModuleStatus::Waiting, words);
    timer_ = loop_.call_at(MonotonicClock::now() + decision.delay, [this] { start_again(); });
    return;
  }
  bool is_given_up = decision.next == Next::GiveUp;
  hear_.event(is_given_up && plan_.restart != Restart::Never
                  ? words + "; failed permanently" +
                        (starts_ > 1 ? " after " + std::to_string(starts_) + " starts" : "")
                  : words);
  change(is_given_up ? ModuleStatus::GivenUp : ModuleStatus::Ended, is_given_up ? words : "");
  hear_.ended();
}

bool Supervised::can_be_cut_off() const {
  return plan_.control_uri.empty() && plan_.restart != Restart::Never;
}

void Supervised::note_interruption() {
  if (!can_be_cut_off()) return;
  is_interrupted_ = true;
  if (awaits_cause_) decide(0);
}

std::string Supervised::said_of(const std::string& uri) const {
  const auto name = uri.substr(0, uri.find('?'));
  for (auto line = lines_.last().rbegin(); !name.empty() && line != lines_.last().rend(); ++line) {
    const auto found = line->find(name);
    if (found == std::string::npos) continue;
    const auto why = line->find(": ", found + name.size());
    return why == std::string::npos ? "" : line->substr(why + 2);
  }
  return "";
}

ModuleState Supervised::state() const {
  ModuleState state;
  state.name = plan_.name;
  state.program = plan_.program;
  state.group = plan_.group;
  state.process = program_;
  state.status = status_;
  state.detail = detail_;
  state.restarts = std::max(0, starts_ - 1);
  state.exit = exit_;
  state.processor = processor_;
  state.memory = usage_.memory;
  state.mode = plan_.mode;
  state.modes = plan_.modes;
  state.in_focus = reports_.state().in_focus;
  if (!lines_.last().empty()) {
    state.last_line = lines_.last().back();
    state.last_line_age = std::chrono::duration<double>(now() - said_at_).count();
  }
  state.parameters = plan_.parameters;
  for (const auto& [key, value] : reports_.parameters()) state.parameters[key] = value;
  return state;
}

}  // namespace hc::internal
