// SPDX-License-Identifier: Apache-2.0
#include <hc/graph/state.h>

#include <algorithm>

#include <nlohmann/json.hpp>

namespace hc {
namespace {

using Json = nlohmann::ordered_json;

Json json_of(const ModuleState& module) {
  return {{"name", module.name},
          {"program", module.program},
          {"pid", module.process},
          {"status", name(module.status)},
          {"detail", module.detail},
          {"restarts", module.restarts},
          {"exit", module.exit ? Json(*module.exit) : Json(nullptr)},
          {"cpu", module.processor},
          {"memory", module.memory},
          {"mode", module.mode},
          {"modes", module.modes},
          {"in_focus", module.in_focus},
          {"in_workspace", module.in_workspace},
          {"parameters", Json(module.parameters)}};
}

Json json_of(const LinkState& link) {
  Json lost = Json::object();
  for (auto [count, reason] : {std::pair(link.traffic.superseded, "superseded"),
                               {link.traffic.over_rate, "over the rate"},
                               {link.traffic.over_memory, "over the memory"},
                               {link.traffic.cut, "cut off"}})
    if (count > 0) lost[reason] = count;
  double rate = 0;
  if (!link.rate.empty()) rate = std::atof(link.rate.c_str());
  return {{"from", link.from},
          {"to", link.to},
          {"transport", link.transport},
          {"keep", link.keep},
          {"rate", rate},
          {"messages", link.traffic.messages},
          {"bytes", link.traffic.bytes},
          {"per_second", link.per_second},
          {"bytes_per_second", link.bytes_per_second},
          {"kept_back", link.traffic.kept_back},
          {"lost", lost},
          {"left_out", link.left_out},
          {"age", link.age ? Json(*link.age) : Json(nullptr)},
          {"gap", link.gap ? Json(*link.gap) : Json(nullptr)},
          {"in_workspace", link.in_workspace}};
}

}  // namespace

std::string_view name(ModuleStatus status) {
  constexpr std::array<std::string_view, 7> kNames = {"starting", "running", "stalled", "waiting",
                                                      "stopping", "ended",   "given up"};
  return kNames.at(static_cast<std::size_t>(status));
}

std::string GraphState::focus_name() const {
  auto found = std::find_if(modes.begin(), modes.end(),
                            [&](const auto& mode) { return mode.second == focus; });
  if (found != modes.end()) return found->first;
  return focus == 0 ? "" : std::to_string(focus);
}

std::string to_json(const GraphState& state) {
  Json json = {{"graph", state.name},
               {"file", state.file},
               {"pid", state.process},
               {"uptime", state.uptime},
               {"status", state.is_stopping ? "stopping" : "running"},
               {"focus", nullptr},
               {"modules", Json::array()},
               {"links", Json::array()},
               {"modes", Json(state.modes)},
               {"addresses", Json(state.addresses)}};
  if (state.focus != 0) json["focus"] = {{"mode", state.focus_name()}, {"number", state.focus}};
  for (const auto& module : state.modules) json["modules"].push_back(json_of(module));
  for (const auto& link : state.links) json["links"].push_back(json_of(link));
  // What modules and files say may be no UTF-8.
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace hc
