// SPDX-License-Identifier: Apache-2.0
#include <graph/run/runner.h>

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>

namespace hc::internal {
namespace {

using MonotonicClock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kTick{250};
constexpr int kTicksOfState = 2, kTicksOfMemory = 8;

}  // namespace

Runner::Runner(LoadedGraph graph, const RunOptions& options, Loop& loop)
    : options_(options),
      plan_(std::move(graph.plan.value())),
      loop_(loop),
      changes_(loop, options.loader, std::move(graph.graph), plan_, log_,
               {[this](const auto& question) { return answer_to(question); },
                [this](const auto& commands) { return set_parameters(commands); },
                [this](Plan plan) { change_to(std::move(plan)); },
                [this](const auto& commands) { carry_out(commands); }}),
      ended_links_(loop, options.hosts, plan_, modules_, log_) {}

Result<RunReport> Runner::run() {
  HC_TRY(begin());
  while (!modules_.are_over()) {
    HC_TRY(loop_.turn());
    settle();
  }
  changes_.stop();
  if (!outcome_) return outcome_.error();
  auto end = state();
  auto& results = log_.results();
  std::ranges::stable_sort(results, {}, [&](const LogLine& line) {
    return std::ranges::find(end.modules, line.module, &ModuleState::name) - end.modules.begin();
  });
  return RunReport{std::move(end), std::move(results), is_stopped_};
}

Status Runner::begin() {
  begun_ = now();
  if (!options_.name.empty()) {
    server_ = HC_TRY(GraphServer::make(
        loop_, {options_.name, ::getpid()},
        {[this] { return state(); },
         [this](const auto& lines, const auto& reply) { changes_.obey(lines, reply); }}));
    log_.publish_by(*server_);
  }
  stop_ = HC_TRY(loop_.watch(options_.stop, options_.stop < 0 ? 0U : EPOLLIN, [this](auto) {
    stop_.reset();
    is_stopped_ = true;
    end_all();
  }));
  if (options_.hosts != nullptr) {
    hosts_ = HC_TRY(
        loop_.watch(options_.hosts->descriptor(), EPOLLIN, [this](auto) { update_hosts(); }));
  }
  HC_TRY(changes_.watch_files());
  // Listen for all modules before starting the first.
  for (const auto& planned : plan_.modules) {
    modules_.insert(planned.name, HC_TRY(make(planned)));
  }
  pollfd stop{options_.stop, POLLIN, 0};
  for (const auto& planned : plan_.modules) {
    if (::poll(&stop, 1, 0) > 0) break;  // the loop will end the started ones
    HC_TRY(modules_.find(planned.name)->start());
  }
  tick();
  return {};
}

Result<std::unique_ptr<Supervised>> Runner::make(const PlannedModule& module) {
  const std::string& name = module.name;
  Supervised::Callbacks callbacks;
  callbacks.event = [this, name](Level level, const auto& text) { log_.add({name, level, text}); };
  callbacks.logged = [this, name](Level level, const auto& text) {
    log_.take({name, level, text});
  };
  callbacks.failed = [this, name](const std::deque<std::string>& last_lines) {
    if (!options_.with_module_lines)
      for (const auto& line : last_lines) log_.print({name, Level::Warning, line});
  };
  callbacks.changed = [this] {
    is_unsettled_ = true;
    if (server_) server_->changed();
  };
  callbacks.ended = [this, name] {
    const Supervised* ended = modules_.find(name);
    if (ended == nullptr || ended->status() != ModuleStatus::GivenUp || is_stopping_) return;
    const bool is_failure = ended->plan().restart == Restart::Never;
    if (is_failure) failures_.push_back({name, ended->exit().value_or(0)});
  };
  callbacks.interrupted = [this, name] {
    for (auto* each : modules_.cut_off_by(name)) each->note_interruption();
  };
  callbacks.is_graph_running = [this] { return is_running_; };
  callbacks.has_work = [this, name] { return !is_stopping_ && modules_.has_work(name); };
  return Supervised::make(loop_, module, options_.limits, std::move(callbacks), options_.hosts);
}

void Runner::tick() {
  const auto time = now();
  for (const auto& [name, module] : modules_.all()) module->check(time);
  if (ticks_++ % kTicksOfState == 0) {
    if (server_ && server_->has_clients()) {
      for (const auto& [name, module] : modules_.all())
        module->measure(time, (ticks_ - 1) % kTicksOfMemory == 0);
      server_->publish_state();
    }
    if (options_.state) options_.state(state());
  }
  tick_ = loop_.call_at(MonotonicClock::now() + kTick, [this] { tick(); });
}

/// Handles lost and restored connections to hosts.
void Runner::update_hosts() {
  for (const auto& line : options_.hosts->take_events()) log_.add(line, Level::Warning);
  for (const auto& [name, module] : modules_.all()) module->check_host();
  is_unsettled_ = true;
  if (server_) server_->changed();
}

/// Handles the consequences of a turn.
void Runner::settle() {
  if (!failures_.empty()) settle_failures();
  for (const auto& [name, module] : modules_.all())
    if (module->plan().ends_graph && module->status() == ModuleStatus::Ended) end_all();
  is_running_ = is_running_ || modules_.have_run();
  while (std::exchange(is_unsettled_, false))
    if (!is_stopping_) ended_links_.settle();
  modules_.forget_left();
}

/// Ends the graph. A killed module is the cause; its peers' errors are symptoms.
void Runner::settle_failures() {
  // Note all ends so far, before the runner's own signals end more modules.
  for (const auto& [name, module] : modules_.all()) module->check_end();
  auto cause = std::find_if(failures_.begin(), failures_.end(),
                            [](const Failure& each) { return each.status > kSignal; });
  if (cause == failures_.end()) cause = failures_.begin();
  outcome_ = Error{Code::Closed, "module " + cause->module + ": " + end_in_words(cause->status)};
  failures_.clear();
  end_all();
}

void Runner::end_all() {
  if (std::exchange(is_stopping_, true)) return;
  if (is_stopped_) log_.add("stopping");
  log_.stop();
  changes_.stop();
  for (const auto& [name, module] : modules_.all()) module->end();
}

}  // namespace hc::internal

namespace hc {

Result<RunReport> run_graph(LoadedGraph graph, const RunOptions& options) {
  std::unique_ptr<Loop> own;  // unless the hosts have one
  if (options.hosts == nullptr) {
    own = HC_TRY(Loop::make());
  }
  return internal::Runner(std::move(graph), options, own ? *own : options.hosts->loop()).run();
}

}  // namespace hc
