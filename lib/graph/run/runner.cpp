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

Result<RunReport> Runner::run() {
  HC_TRY(begin());
  while (!is_over()) {
    HC_TRY(loop_->turn());
    settle();
  }
  refuse_changes();
  if (!outcome_) return outcome_.error();
  auto end = state();
  std::ranges::stable_sort(results_, {}, [&](const LogLine& line) {
    return std::ranges::find(end.modules, line.module, &ModuleState::name) - end.modules.begin();
  });
  return RunReport{std::move(end), std::move(results_), is_stopped_};
}

Status Runner::begin() {
  begun_ = now();
  if (options_.hosts == nullptr) {
    own_loop_ = HC_TRY(Loop::make());
  }
  loop_ = own_loop_ ? own_loop_.get() : &options_.hosts->loop();
  if (!options_.name.empty())
    server_ = HC_TRY(
        GraphServer::make(*loop_, {options_.name, ::getpid()},
                          {[this] { return state(); },
                           [this](const auto& lines, const auto& reply) { obey(lines, reply); }}));
  stop_ = HC_TRY(loop_->watch(options_.stop, options_.stop < 0 ? 0U : EPOLLIN, [this](auto) {
    stop_.reset();
    is_stopped_ = true;
    end_all();
  }));
  if (options_.hosts != nullptr) {
    hosts_ = HC_TRY(
        loop_->watch(options_.hosts->descriptor(), EPOLLIN, [this](auto) { update_hosts(); }));
  }
  if (options_.loader != nullptr && !graph_.files.empty()) {
    files_ = HC_TRY(FileWatch::make(*loop_, graph_.files, [this] { reload(); }));
  }
  // Listen for all modules before starting the first.
  for (const auto& planned : plan_.modules) {
    modules_[planned.name] = HC_TRY(make(planned));
  }
  pollfd stop{options_.stop, POLLIN, 0};
  for (const auto& planned : plan_.modules) {
    if (::poll(&stop, 1, 0) > 0) break;  // the loop will end the started ones
    HC_TRY(find(planned.name)->start());
  }
  tick();
  return {};
}

Result<std::unique_ptr<Supervised>> Runner::make(const PlannedModule& module) {
  const std::string& name = module.name;
  Supervised::Callbacks callbacks;
  callbacks.event = [this, name](Level level, const auto& text) { log({name, level, text}); };
  callbacks.logged = [this, name](Level level, const auto& text) {
    take_line({name, level, text});
  };
  callbacks.failed = [this, name](const std::deque<std::string>& last_lines) {
    if (!options_.with_module_lines)
      for (const auto& line : last_lines) print({name, Level::Warning, line});
  };
  callbacks.changed = [this] {
    is_unsettled_ = true;
    if (server_) server_->changed();
  };
  callbacks.ended = [this, name] {
    const Supervised* ended = find(name);
    if (ended == nullptr || ended->status() != ModuleStatus::GivenUp || is_stopping_) return;
    const bool is_failure = ended->plan().restart == Restart::Never;
    if (is_failure) failures_.push_back({name, ended->exit().value_or(0)});
  };
  callbacks.interrupted = [this, name] {
    for (auto* each : cut_off_by(name)) each->note_interruption();
  };
  callbacks.is_graph_running = [this] { return is_running_; };
  callbacks.has_work = [this, name] {
    bool has_writers = false, is_written_to = false, is_read = false;
    for (const auto& link : plan_.links) {
      const Supervised *from = at(link.from), *to = at(link.to);
      if (from == nullptr || to == nullptr || from == to) continue;
      has_writers = has_writers || to->plan().name == name;
      is_written_to = is_written_to || (to->plan().name == name && !from->is_over());
      is_read = is_read || (from->plan().name == name && !to->is_over());
    }
    return !is_stopping_ && (has_writers ? is_written_to : is_read);
  };
  return Supervised::make(*loop_, module, options_.limits, std::move(callbacks), options_.hosts);
}

Supervised* Runner::find(const std::string& name) const {
  auto found = modules_.find(name);
  return found == modules_.end() ? nullptr : found->second.get();
}

Supervised* Runner::at(const std::string& end) const {
  return find(end.substr(0, end.find('.')));
}

/// The modules linked to a module, except itself.
std::set<Supervised*> Runner::neighbours_of(const std::string& name) const {
  std::set<Supervised*> neighbours;
  for (const auto& link : plan_.links) {
    Supervised *from = at(link.from), *to = at(link.to);
    if (from == nullptr || to == nullptr || from == to) continue;
    if (from->plan().name == name) neighbours.insert(to);
    if (to->plan().name == name) neighbours.insert(from);
  }
  return neighbours;
}

/// The modules that end, temporarily, when a module ends: its neighbours without `control`, and
/// transitively theirs, in any order.
std::set<Supervised*> Runner::cut_off_by(const std::string& name) const {
  std::set<Supervised*> cut_off;
  std::vector<std::string> way = {name};
  while (!way.empty()) {
    const std::string last = std::move(way.back());
    way.pop_back();
    for (auto* each : neighbours_of(last))
      if (each->plan().control_uri.empty() && each->plan().name != name &&
          cut_off.insert(each).second)
        way.push_back(each->plan().name);
  }
  return cut_off;
}

void Runner::print(const LogLine& line) const {
  if (options_.event) options_.event(line);
}

void Runner::log(const LogLine& line) {
  print(line);
  if (server_) server_->log(line);
}

void Runner::take_line(LogLine line) {
  if (is_stopping_ && line.level == Level::Warning) return;  // its peers are stopping too
  line.text = with_link_names(std::move(line.text));
  const bool is_error = line.level == Level::Error;
  if ((is_error || line.level == Level::Result) && results_.size() < kMaxResults)
    results_.push_back(line);
  if (options_.with_module_lines || is_error || line.level == Level::Notice) print(line);
  if (server_ && line.level != Level::Notice) server_->log(line);
}

/// Replaces a link's URI by "MODULE.PORT → MODULE.PORT".
std::string Runner::with_link_names(std::string line) const {
  const bool has_token = !plan_.token.empty() && line.find(plan_.token) != std::string::npos;
  if (!has_token && plan_.ports.empty()) return line;
  for (const auto& link : plan_.links)
    for (const auto* uri : {&link.reader_uri, &link.sender_uri}) {
      const bool is_inside = !link.reader_uri.empty() && !link.sender_uri.empty();
      const auto found = is_inside ? line.find(*uri) : std::string::npos;
      if (found != std::string::npos)
        return line.replace(found, uri->size(), link.from + " → " + link.to);
    }
  return line;
}

void Runner::tick() {
  const auto time = now();
  for (auto& [name, module] : modules_) module->check(time);
  if (ticks_++ % kTicksOfState == 0) {
    if (server_ && server_->has_clients()) {
      for (auto& [name, module] : modules_)
        module->measure(time, (ticks_ - 1) % kTicksOfMemory == 0);
      server_->publish_state();
    }
    if (options_.state) options_.state(state());
  }
  tick_ = loop_->call_at(MonotonicClock::now() + kTick, [this] { tick(); });
}

/// Handles lost and restored connections to hosts.
void Runner::update_hosts() {
  for (const auto& line : options_.hosts->take_events()) log(line, Level::Warning);
  for (auto& [name, module] : modules_) module->check_host();
  is_unsettled_ = true;
  if (server_) server_->changed();
}

bool Runner::is_over() const {
  return leaving_.empty() && std::all_of(modules_.begin(), modules_.end(),
                                         [](const auto& entry) { return entry.second->is_over(); });
}

/// Handles the consequences of a turn.
void Runner::settle() {
  if (!failures_.empty()) settle_failures();
  for (const auto& [name, module] : modules_)
    if (module->plan().ends_graph && module->status() == ModuleStatus::Ended) end_all();
  is_running_ = is_running_ || std::ranges::all_of(modules_, [](const auto& entry) {
                  return entry.second->has_run();
                });
  while (std::exchange(is_unsettled_, false)) settle_links();
  std::erase_if(leaving_, [](const auto& entry) { return entry.second->is_over(); });
}

/// Ends the graph. A killed module is the cause; its peers' errors are symptoms.
void Runner::settle_failures() {
  // Note all ends so far, before the runner's own signals end more modules.
  for (auto& [name, module] : modules_) module->check_end();
  auto cause = std::find_if(failures_.begin(), failures_.end(),
                            [](const Failure& each) { return each.status > kSignal; });
  if (cause == failures_.end()) cause = failures_.begin();
  outcome_ = Error{Code::Closed, "module " + cause->module + ": " + end_in_words(cause->status)};
  failures_.clear();
  end_all();
}

void Runner::end_all() {
  if (std::exchange(is_stopping_, true)) return;
  if (is_stopped_) log("stopping");
  refuse_changes();
  for (auto& [name, module] : modules_) module->end();
}

/// Makes sure that no module waits for a reader or writer that has ended for good.
void Runner::settle_links() {
  if (is_stopping_) return;
  std::map<LinkName, const PlannedLink*> to_read;  // instead of their readers
  for (const auto& link : plan_.links) {
    const Supervised* writer = at(link.from);
    Supervised* reader = at(link.to);
    if (writer == nullptr || reader == nullptr) continue;
    if (reader->is_over() && !writer->is_over()) to_read[{link.from, link.to}] = &link;
    if (reader->is_over() || !link.reconnects) continue;
    reader->finish_input(link.end(true), writer->status() == ModuleStatus::Ended);
  }
  std::erase_if(drains_, [&](const auto& entry) { return !to_read.contains(entry.first); });
  for (const auto& [name, link] : to_read) {
    if (drains_.contains(name)) continue;
    auto drain = drain_for(at(link->to)->plan(), link->reader_uri);
    if (!drain) log(link->reader_uri + ": " + drain.error().text(), Level::Warning);
    drains_[name] = drain ? std::move(*drain) : nullptr;
  }
  end_unneeded();
}

/// Reads a link in place of a module that has ended, on its host.
Result<std::shared_ptr<void>> Runner::drain_for(const PlannedModule& reader,
                                                const std::string& uri) const {
  if (!reader.host.empty() && options_.hosts != nullptr)
    if (auto host = options_.hosts->find(reader.host)) return host->read_in_place(uri);
  return read_in_place_here(*loop_, uri, options_.hosts == nullptr ? -1 : options_.hosts->key());
}

/// Ends modules whose readers have all finished.
void Runner::end_unneeded() {
  std::map<std::string, bool> is_needed;  // by writer
  for (const auto& link : plan_.links) {
    const Supervised* reader = at(link.to);
    const bool is_done = reader != nullptr && reader->status() == ModuleStatus::Ended;
    bool& needed = is_needed[link.from.substr(0, link.from.find('.'))];
    needed = needed || !is_done;
  }
  for (const auto& [name, needed] : is_needed) {
    Supervised* writer = find(name);
    if (needed || writer == nullptr || writer->is_over() || writer->is_to_end() ||
        writer->plan().restart == Restart::Always)
      continue;
    writer->dismiss();
  }
}

}  // namespace hc::internal

namespace hc {

Result<RunReport> run_graph(LoadedGraph graph, const RunOptions& options) {
  return internal::Runner(std::move(graph), options).run();
}

}  // namespace hc
