// SPDX-License-Identifier: Apache-2.0
#include "trace_paths.h"

#include <algorithm>
#include <iterator>
#include <optional>
#include <tuple>
#include <utility>

namespace tool {
namespace {

using What = hc::TraceEvent::What;

constexpr std::size_t kMostSteps = 64;
constexpr std::chrono::seconds kMaxAge{1};  // older messages do not affect a new one
constexpr int kMostVisited = 10'000;        // outputs, for one message

/// A message at an input.
struct Visit {
  std::string port;
  hc::MessageKey key;
  hc::Time took;
  std::optional<hc::Time> began, ended;
};

struct Sending {
  std::string module, port;
  hc::MessageKey key;
  hc::Time moment;
};

struct Module {
  std::vector<Visit> visits;                        // in the order of arrival
  std::vector<std::pair<hc::Time, hc::Time>> busy;  // disjoint periods, in order
  std::multimap<hc::Time, const Visit*> at_time;    // by time of the message
  /// Handled messages with a time, by input, in the order of their handlers.
  std::map<std::string, std::vector<const Visit*>> handled;

  /// The time within a period during which a handler was running.
  [[nodiscard]] nanoseconds busy_within(hc::Time begin, hc::Time end) const {
    nanoseconds sum{0};
    auto each = std::ranges::lower_bound(busy, begin, {}, [](const auto& b) { return b.second; });
    for (; each != busy.end() && each->first < end; ++each)
      sum += std::max(std::min(end, each->second) - std::max(begin, each->first), nanoseconds(0));
    return sum;
  }
};

/// Groups the events of a module by message. A moment before the one that it follows (the clock was
/// set, or the trace is forged) counts as none.
Module read_module(const std::vector<hc::TraceEvent>& events) {
  Module module;
  std::map<std::pair<std::string, hc::MessageKey>, std::size_t>
      open;  // the newest visit of each message
  hc::Time begin;
  int depth = 0;  // synchronised messages are handled together
  for (const auto& event : events) {
    const auto name = std::pair(event.port, event.key());
    const auto known = open.find(name);
    Visit* visit = known == open.end() ? nullptr : &module.visits[known->second];
    if (event.what == What::Took) {
      open[name] = module.visits.size();
      module.visits.push_back({event.port, event.key(), event.moment, {}, {}});
    } else if (event.what == What::Began) {
      if (depth++ == 0) begin = event.moment;
      if (visit != nullptr && event.moment >= visit->took) visit->began = event.moment;
    } else if (event.what == What::Ended) {
      if (visit != nullptr && visit->began && event.moment >= *visit->began)
        visit->ended = event.moment;
      depth = std::max(depth - 1, 0);  // the trace may begin within a handler
      const hc::Time last = module.busy.empty() ? hc::Time() : module.busy.back().second;
      if (depth == 0 && begin != hc::Time() && last <= begin && begin <= event.moment)
        module.busy.emplace_back(begin, event.moment);
    }
  }
  for (const auto& visit : module.visits) {
    const auto time = visit.key.time;
    module.at_time.emplace(time, &visit);
    if (visit.began && time != hc::Time()) module.handled[visit.port].push_back(&visit);
  }
  for (auto& [port, visits] : module.handled)
    std::ranges::stable_sort(visits, {}, [](const Visit* visit) { return *visit->began; });
  return module;
}

class PathFinder {
 public:
  explicit PathFinder(const Traced& traced) : links_(traced.links) {
    for (const auto& [name, events] : traced.events) {
      modules_[name] = read_module(events);
      for (const auto& event : events)
        if (event.what == What::Sent) {
          const Sending sending{name, event.port, event.key(), event.moment};
          sent_[sending.key].push_back(sending);
          sent_at_time_[event.time].push_back(sending);
        }
    }
  }

  std::vector<MessagePath> find(const std::string& port) {
    const std::string name = module_of(port);
    const std::string at = port.substr(std::min(port.size(), name.size() + 1));
    const auto module = modules_.find(name);
    if (module == modules_.end()) return {};
    may_renew_at_ = 1;
    for (const auto& visit : module->second.visits)
      if (visit.port == at && visit.key.time != hc::Time())
        collect([&] { arrive(name, visit); }, visit.took, visit.key.time);
    if (!found_.empty()) return std::move(found_);
    may_renew_at_ = 0;
    for (const auto& [time, sendings] : sent_at_time_)
      for (const auto& sending : sendings)
        if (time != hc::Time() && sending.module == name && sending.port == at)
          collect([&] { leave(sending); }, sending.moment, time);
    return std::move(found_);
  }

 private:
  /// Walks backwards from a port; `back_` has the later steps.
  template <typename Walk>
  void collect(const Walk& walk, hc::Time end, hc::Time time) {
    back_.clear();
    is_critical_ = true;
    end_ = end;
    age_ = end - time;
    first_ = found_.size();
    visited_ = 0;
    walk();
  }

  void finish(Step step, hc::Time time) {
    MessagePath path;
    path.steps.assign(back_.rbegin(), back_.rend());
    path.steps.insert(path.steps.begin(), std::move(step));
    path.age = age_;
    path.total = end_ - time;
    path.is_critical = is_critical_;
    found_.push_back(std::move(path));
  }

  /// Continues the walk; the path stays critical only if this input is.
  template <typename Walk>
  void branch(bool is_critical, const Walk& walk) {
    const bool was_critical = std::exchange(is_critical_, is_critical_ && is_critical);
    walk();
    is_critical_ = was_critical;
  }

  /// Starts at an input.
  void arrive(const std::string& name, const Visit& visit) {
    Step step{name, visit.port, "", false, {}, {}, {}};
    if (visit.began) {
      step.waiting = *visit.began - visit.took;
      step.processing = visit.ended.value_or(*visit.began) - *visit.began;
    }
    before(name, visit, step);
  }

  /// Continues at the sender of a message; completes `step` with the time before its arrival.
  void before(const std::string& name, const Visit& visit, Step step) {
    if (back_.size() == kMostSteps) return;
    const auto sending = sender(name, visit);
    if (sending == nullptr) return outside(name, visit, std::move(step));
    const auto busy = modules_.at(name).busy_within(sending->moment, visit.took);
    step.link += visit.took - sending->moment - busy;
    step.waiting += busy;
    back_.push_back(std::move(step));
    leave(*sending);
    back_.pop_back();
  }

  /// The last sender of a message before its arrival.
  [[nodiscard]] const Sending* sender(const std::string& name, const Visit& visit) const {
    const auto same = sent_.find(visit.key);
    const Sending* last = nullptr;
    if (same == sent_.end()) return nullptr;
    for (const auto& each : same->second)
      if (each.moment <= visit.took && each.module != name &&
          (last == nullptr || each.moment > last->moment) &&
          is_linked(each.module + "." + each.port, name + "." + visit.port))
        last = &each;
    return last;
  }

  [[nodiscard]] bool is_linked(const std::string& from, const std::string& to) const {
    return links_.empty() || std::ranges::find(links_, std::pair(from, to)) != links_.end() ||
           // Links added by `hc run` may not be among them.
           std::ranges::none_of(links_, [&](const auto& link) { return link.second == to; });
  }

  /// Continues at a sender without a trace: a module or a URI.
  void outside(const std::string& name, const Visit& visit, Step step) {
    std::string from;
    for (const auto& link : links_)
      if (link.second == name + "." + visit.port && !modules_.contains(module_of(link.first)))
        from = link.first;
    if (from.empty()) {
      if (!links_.empty()) return;  // sent before the trace began
      from = "outside.";
    }
    const bool is_uri = from.find(':') != std::string::npos;
    Step other{is_uri ? from : module_of(from),
               "",
               is_uri ? "" : from.substr(from.find('.') + 1),
               true,
               {},
               {},
               {}};
    back_.push_back(std::move(step));
    const auto time = visit.key.time;
    std::map<std::string, const Sending*> inputs;  // last message sent to each input of the module
    const auto same = sent_at_time_.find(time);
    for (const auto& link : links_) {
      if (is_uri || module_of(link.second) != other.module || same == sent_at_time_.end()) continue;
      for (const auto& each : same->second)
        if (each.moment <= visit.took && each.module + "." + each.port == link.first)
          inputs[link.second] = &each;
    }
    if (inputs.empty()) {
      other.processing = visit.took - time;
      finish(other, time);
    }
    const Sending* last = inputs.empty() ? nullptr : inputs.begin()->second;
    for (const auto& [to, sending] : inputs)
      if (sending->moment > last->moment) last = sending;
    for (const auto& [to, sending] : inputs) {
      Step through = other;
      through.in = to.substr(to.find('.') + 1);
      through.processing = visit.took - sending->moment;
      back_.push_back(std::move(through));
      branch(sending == last, [&, from = sending] { leave(*from); });
      back_.pop_back();
    }
    back_.pop_back();
  }

  /// Continues at the messages from which a module has derived another.
  void leave(const Sending& sending) {
    if (found_.size() - first_ == kMostPaths || ++visited_ > kMostVisited) return;
    const auto& module = modules_.at(sending.module);
    const auto time = sending.key.time;
    std::map<std::string, const Visit*> inputs;  // last message at each
    const auto [begin, end] = module.at_time.equal_range(time);
    for (auto each = begin; each != end; ++each)
      if (each->second->began && *each->second->began <= sending.moment)
        inputs[each->second->port] = each->second;
    const bool renews = inputs.empty() && back_.size() == may_renew_at_;
    if (renews) inputs = last_handled(module, sending.moment);
    const auto before_this = found_.size();
    follow(sending, inputs, renews);
    if (inputs.empty() || (renews && found_.size() == before_this))
      finish({sending.module, "", sending.port, false, {}, {}, sending.moment - time}, time);
  }

  /// The last message at each input within kMaxAge.
  static std::map<std::string, const Visit*> last_handled(const Module& module, hc::Time moment) {
    std::map<std::string, const Visit*> inputs;
    for (const auto& [port, visits] : module.handled) {
      const auto later = std::ranges::upper_bound(visits, moment, {},
                                                  [](const Visit* visit) { return *visit->began; });
      if (later == visits.begin()) continue;
      if (const Visit* last = *std::prev(later); *last->began > moment - kMaxAge)
        inputs[port] = last;
    }
    return inputs;
  }

  /// Continues at each of the messages from which another was derived.
  void follow(const Sending& sending, const std::map<std::string, const Visit*>& inputs,
              bool renews) {
    if (inputs.empty()) return;
    const auto& module = modules_.at(sending.module);
    const Visit* last = inputs.begin()->second;
    for (const auto& [port, visit] : inputs)
      if (renews ? visit->key.time < last->key.time : visit->took > last->took) last = visit;
    for (const auto& [port, visit] : inputs) {
      Step step{sending.module, port, sending.port, false, {}, {}, {}, renews};
      // A handler that is still running counts up to the moment of sending.
      const auto running = visit->ended && *visit->ended <= sending.moment
                               ? module.busy_within(*visit->began, sending.moment)
                               : sending.moment - *visit->began;
      step.processing = running;
      step.waiting = sending.moment - visit->took - running;
      branch(visit == last, [&, at = visit] { before(sending.module, *at, std::move(step)); });
    }
  }

  std::vector<std::pair<std::string, std::string>> links_;
  std::map<std::string, Module> modules_;
  std::map<hc::MessageKey, std::vector<Sending>> sent_;
  std::map<hc::Time, std::vector<Sending>> sent_at_time_;
  std::vector<MessagePath> found_;
  std::vector<Step> back_;
  std::size_t may_renew_at_ = 0;  // number of later steps at which a module may renew the time
  bool is_critical_ = true;
  hc::Time end_;
  nanoseconds age_{0};
  std::size_t first_ = 0;  // index of this message's first path
  int visited_ = 0;
};

}  // namespace

std::string module_of(const std::string& port) {
  return port.substr(0, port.find('.'));
}

std::string Step::text() const {
  if (in.empty()) return out.empty() ? module : module + "." + out;
  return out.empty() ? module + "." + in : module + ": " + in + " → " + out;
}

std::vector<MessagePath> find_paths(const Traced& traced, const std::string& port) {
  return PathFinder(traced).find(port);
}

Spread spread_of(std::vector<nanoseconds> durations) {
  if (durations.empty()) return {};
  std::ranges::sort(durations);
  return {durations[(durations.size() - 1) / 2], durations[(durations.size() - 1) * 99 / 100]};
}

std::vector<PathSummary> summarise(const std::vector<MessagePath>& paths) {
  std::map<std::string, std::vector<const MessagePath*>> ways;
  for (const auto& path : paths) {
    std::string way;
    for (const auto& step : path.steps) way += step.text() + "\n";
    ways[way].push_back(&path);
  }
  std::vector<PathSummary> summaries;
  for (const auto& way : ways) {
    const auto& same = way.second;
    auto& summary = summaries.emplace_back();
    summary.steps = same.front()->steps;
    summary.messages = same.size();
    summary.critical = static_cast<std::size_t>(
        std::ranges::count_if(same, [](const auto* path) { return path->is_critical; }));
    auto spread = [&](const auto& duration) {
      std::vector<nanoseconds> all;
      all.reserve(same.size());
      for (const auto* path : same) all.push_back(duration(*path));
      return spread_of(std::move(all));
    };
    summary.age = spread([](const MessagePath& path) { return path.age; });
    summary.total = spread([](const MessagePath& path) { return path.total; });
    for (std::size_t i = 0; i < summary.steps.size(); ++i)
      summary.durations.push_back(
          {spread([i](const MessagePath& path) { return path.steps[i].link; }),
           spread([i](const MessagePath& path) { return path.steps[i].waiting; }),
           spread([i](const MessagePath& path) { return path.steps[i].processing; })});
  }
  std::ranges::stable_sort(summaries, [](const auto& a, const auto& b) {
    return std::tie(a.critical, a.messages) > std::tie(b.critical, b.messages);
  });
  return summaries;
}

}  // namespace tool
