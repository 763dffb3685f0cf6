// SPDX-License-Identifier: Apache-2.0
// The state of a running graph, from the reports of its modules.
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>

#include <graph/global_workspace.h>
#include <graph/run/runner.h>
#include <hc/base/format.h>
#include <hc/link/policy.h>

namespace hc::internal {
namespace {

/// The input for which a module waits. If several share the sending end: those with keep = "all",
/// and among them those that do not run.
std::string waited_for(const std::string& name, const Plan& plan, const RunningModules& modules) {
  std::vector<const PlannedLink*> links;
  for (const auto& link : plan.links)
    if (link.from.starts_with(name + ".") && modules.find(name)->waits_on(link))
      links.push_back(&link);
  auto keep_some = [&](const auto& is_wanted) {
    if (std::ranges::any_of(links, is_wanted))
      std::erase_if(links, [&](const auto* link) { return !is_wanted(link); });
  };
  keep_some([](const auto* link) { return link->keep == "all"; });
  keep_some([&](const auto* link) {
    const auto* reader = modules.at(link->to);
    return reader != nullptr && reader->status() != ModuleStatus::Running;
  });
  std::vector<std::string> inputs;
  inputs.reserve(links.size());
  for (const auto* link : links) inputs.push_back(link->to);
  return joined(inputs, " or ");
}

LinkState state_of(const PlannedLink& link, const RunningModules& modules, bool is_stopping) {
  LinkState state;
  state.from = link.from;
  state.to = link.to;
  state.keep = link.keep;
  const std::string& inside = link.reader_uri.empty() ? link.sender_uri : link.reader_uri;
  state.transport = inside.substr(0, inside.find_first_of("-:"));
  if (auto rate = link.policy.find("rate"); rate != link.policy.end())
    state.rate = std::atof(rate->second.c_str());
  if (auto limit = link.policy.find("bandwidth"); limit != link.policy.end())
    state.bandwidth = static_cast<double>(parse_bandwidth(limit->second).value_or(0));
  for (const auto* module : {modules.at(link.from), modules.at(link.to)}) {
    const auto status = module == nullptr ? ModuleStatus::Running : module->status();
    const bool is_up = status == ModuleStatus::Running || status == ModuleStatus::Ended;
    if (!is_up && !is_stopping)
      state.status = module->plan().name + ": " + std::string(name(status));
  }
  auto report_of = [&](bool is_input) {
    const auto* module = modules.at(is_input ? link.to : link.from);
    return module == nullptr ? nullptr : module->reports().find(link.end(is_input));
  };
  const auto *sender = report_of(false), *reader = report_of(true);
  const auto* counts = sender != nullptr ? sender : reader;
  if (counts != nullptr) state.traffic = counts->traffic;
  if (counts != nullptr && counts->scale >= 0)
    state.images = {
        {static_cast<double>(counts->quality), static_cast<double>(counts->scale) / 1000}};
  // Rates are the reader's: a sender also counts queued and dropped messages.
  if (const auto* last = reader != nullptr ? reader : counts; last != nullptr) {
    state.per_second = last->per_second;
    state.bytes_per_second = last->bytes_per_second;
  }
  // Between modules, their states explain why nothing passes.
  const bool is_input = link.sender_uri.empty();
  const bool is_outside = is_input || link.reader_uri.empty();
  const auto* inner = modules.at(is_input ? link.to : link.from);
  if (is_outside && state.status.empty() && inner != nullptr) {
    if (!inner->reports().is_open(link.end(is_input)))
      state.status = kNotOpen;
    else if (inner->reports().peers_of(link.end(is_input)) == 0)
      state.status = kNotConnected;
  }
  if (reader == nullptr) return state;
  if (counts != reader) {
    Traffic lost = reader->traffic;
    lost.messages = lost.bytes = 0;
    state.traffic += lost;
  }
  state.ignored = reader->ignored;
  auto seconds = [](const std::array<std::int64_t, 3>& times) {
    std::optional<std::array<double, 3>> result;
    if (times[0] < 0) return result;
    result.emplace();
    std::transform(times.begin(), times.end(), result->begin(), [](std::int64_t time) {
      return std::chrono::duration<double>(std::chrono::nanoseconds(time)).count();
    });
    return result;
  };
  state.age = seconds(reader->age);
  state.gap = seconds(reader->gap);
  return state;
}

}  // namespace

GraphState Runner::state() const {
  GraphState state;
  state.name = options_.name;
  state.file = options_.file;
  state.process = ::getpid();
  state.uptime = std::chrono::duration<double>(SystemClock().monotonic() - begun_).count();
  state.is_stopping = is_stopping_;
  for (const auto& workspace : plan_.workspaces) state.focus[workspace] = 0;
  state.modes = plan_.modes;
  state.addresses = plan_.addresses;
  for (const auto& declared : changes_.graph().hosts)
    if (const auto host = options_.hosts == nullptr ? nullptr : options_.hosts->find(declared.name))
      state.hosts.push_back(host->state());
  const auto source_names = [this] {
    std::map<std::int32_t, std::string> names;
    for (const auto& [name, number] : plan_.sources)
      names[static_cast<std::int32_t>(number)] = name;
    return names;
  };
  for (const auto& planned : plan_.modules) {
    const auto* module = modules_.find(planned.name);
    if (module == nullptr) continue;
    state.modules.push_back(module->state());
    state.modules.back().last_line =
        log_.with_link_names(std::move(state.modules.back().last_line));
    // A stop outlives the process that reported it.
    if (const auto& stops = module->reports().state().stops; any_stops(stops))
      state.stopped[planned.name] = names_of_stops(stops, source_names());
    // The focus, as reported by modules that receive or decide it; stale unless they run.
    if (module->status() != ModuleStatus::Running) continue;
    const bool decides = plan_.workspaces.contains(planned.name);
    const auto focus = state.focus.find(decides ? planned.name : planned.workspace);
    if (focus != state.focus.end() && focus->second == 0)
      focus->second = module->reports().state().focus;
  }
  for (auto& module : state.modules)
    if (module.waits) module.waits_for = waited_for(module.name, plan_, modules_);
  for (const auto& link : plan_.links)
    state.links.push_back(state_of(link, modules_, is_stopping_));
  std::map<std::string, std::string> focus;
  for (const auto& [name, number] : state.focus) focus[name] = state.mode_name(number);
  const auto workspace = global_workspace(plan_, focus);
  for (auto& module : state.modules) module.in_workspace = workspace.modules.contains(module.name);
  for (auto number : workspace.links) state.links.at(number).in_workspace = true;
  return state;
}

}  // namespace hc::internal
