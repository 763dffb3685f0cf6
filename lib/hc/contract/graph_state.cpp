// SPDX-License-Identifier: Apache-2.0
#include <hc/contract/graph_state.h>

#include <algorithm>
#include <cstdlib>

#include <nlohmann/json.hpp>

#include <hc/base/text.h>

namespace hc {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array<std::string_view, 7> kStatusNames = {
    "starting", "running", "stalled", "waiting", "stopping", "ended", "given up"};

/// Writes the fields of a struct into a JSON object.
struct FieldWriter {
  Json& json;

  template <typename T>
  void operator()(const char* key, const T& value) {
    json[key] = value;
  }
  template <typename T>
  void operator()(const char* key, const std::optional<T>& value) {
    json[key] = value ? Json(*value) : Json(nullptr);
  }
  void operator()(const char* key, ModuleStatus value) { json[key] = name(value); }
  void operator()(const char* key, Level value) { json[key] = name(value); }
};

/// Reads the fields; throws Json's exceptions. If a key is absent, its field keeps its value, so
/// that newer tools can read older graphs.
struct FieldReader {
  const Json& json;

  template <typename T>
  void operator()(const char* key, T& value) {
    if (auto found = json.find(key); found != json.end()) found->get_to(value);
  }
  template <typename T>
  void operator()(const char* key, std::optional<T>& value) {
    if (auto found = json.find(key); found != json.end() && !found->is_null())
      value = found->get<T>();
  }
  void operator()(const char* key, ModuleStatus& value) {
    const auto text = json.value(key, std::string());
    value = enum_named<ModuleStatus>(kStatusNames, text).value_or(value);
  }
  void operator()(const char* key, Level& value) {
    value = level_named(json.value(key, std::string())).value_or(value);
  }
};

template <typename Module, typename Visit>
void visit_module(Module& module, Visit visit) {
  visit("name", module.name);
  visit("program", module.program);
  visit("host", module.host);
  visit("group", module.group);
  visit("pid", module.process);
  visit("status", module.status);
  visit("detail", module.detail);
  visit("restarts", module.restarts);
  visit("exit", module.exit);
  visit("cpu", module.processor);
  visit("memory", module.memory);
  visit("mode", module.mode);
  visit("modes", module.modes);
  visit("workspace", module.workspace);
  visit("in_focus", module.in_focus);
  visit("in_workspace", module.in_workspace);
  visit("waits_for", module.waits_for);
  visit("waits", module.waits);
  visit("last_line", module.last_line);
  visit("last_level", module.last_level);
  visit("last_line_age", module.last_line_age);
  visit("parameters", module.parameters);
}

template <typename Host, typename Visit>
void visit_host(Host& host, Visit visit) {
  visit("name", host.name);
  visit("connected", host.is_connected);
  visit("detail", host.detail);
  visit("offset", host.offset);
  visit("error", host.error);
  visit("drift", host.drift);
  visit("latency", host.latency);
}

template <typename Link, typename Visit>
void visit_link(Link& link, Visit visit) {
  visit("from", link.from);
  visit("to", link.to);
  visit("transport", link.transport);
  visit("status", link.status);
  visit("keep", link.keep);
  visit("rate", link.rate);
  visit("bandwidth", link.bandwidth);
  visit("images", link.images);
  visit("messages", link.traffic.messages);
  visit("bytes", link.traffic.bytes);
  visit("per_second", link.per_second);
  visit("bytes_per_second", link.bytes_per_second);
  visit("delayed", link.traffic.delayed);
  visit("throttled", link.traffic.throttled);
  visit("dropped_newer", link.traffic.dropped_newer);
  visit("dropped_memory", link.traffic.dropped_memory);
  visit("dropped_disconnect", link.traffic.dropped_disconnect);
  visit("dropped_timeout", link.traffic.dropped_timeout);
  visit("ignored", link.ignored);
  visit("bad", link.traffic.bad);
  visit("age", link.age);
  visit("gap", link.gap);
  visit("in_workspace", link.in_workspace);
}

template <typename Graph, typename Visit>
void visit_graph(Graph& graph, Visit visit) {
  visit("graph", graph.name);
  visit("file", graph.file);
  visit("pid", graph.process);
  visit("uptime", graph.uptime);
  visit("modes", graph.modes);
  visit("addresses", graph.addresses);
}

}  // namespace

std::string_view name(ModuleStatus status) {
  return kStatusNames.at(static_cast<std::size_t>(status));
}

std::string GraphState::mode_name(std::int64_t number) const {
  auto found = std::find_if(modes.begin(), modes.end(),
                            [&](const auto& mode) { return mode.second == number; });
  if (found != modes.end()) return found->first;
  return number == 0 ? "" : std::to_string(number);
}

std::string GraphState::focus_of(const ModuleState& module) const {
  const auto found = focus.find(module.workspace);
  return found == focus.end() ? "" : mode_name(found->second);
}

std::string GraphState::focus_in_words() const {
  std::string words;
  bool is_any = false;
  for (const auto& [workspace, number] : focus) {
    is_any = is_any || number != 0;
    if (focus.size() == 1) return mode_name(number);
    if (!words.empty()) words += ", ";
    words += workspace + ": " + (number == 0 ? "none" : mode_name(number));
  }
  return is_any ? words : "";
}

std::string GraphState::stopped_in_words() const {
  std::string words;
  for (const auto& [workspace, sources] : stopped) {
    words += words.empty() ? "stopped" : "; ";
    if (focus.size() > 1) words += (words == "stopped" ? ": " : "") + workspace;
    for (const auto& source : sources)
      words += (source == sources.front() ? " by " : ", ") + source;
  }
  return words;
}

std::string to_json(const GraphState& state) {
  Json json = Json::object();
  visit_graph(state, FieldWriter{json});
  auto& stopped = json["stopped"] = Json::array();
  for (const auto& [workspace, sources] : state.stopped) stopped.push_back(workspace);
  json["stopped_by"] = state.stopped;
  json["status"] = state.is_stopping ? "stopping" : "running";
  auto& focus = json["focus"] = Json::object();
  for (const auto& [workspace, number] : state.focus)
    focus[workspace] =
        number == 0 ? Json(nullptr) : Json{{"mode", state.mode_name(number)}, {"number", number}};
  for (const char* list : {"hosts", "modules", "links"}) json[list] = Json::array();
  for (const auto& host : state.hosts)
    visit_host(host, FieldWriter{json["hosts"].emplace_back(Json::object())});
  for (const auto& module : state.modules)
    visit_module(module, FieldWriter{json["modules"].emplace_back(Json::object())});
  for (const auto& link : state.links)
    visit_link(link, FieldWriter{json["links"].emplace_back(Json::object())});
  // Texts of modules and files may not be UTF-8.
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

Result<GraphState> parse_graph_state(std::string_view text) {
  try {
    const auto json = Json::parse(text);
    GraphState state;
    visit_graph(state, FieldReader{json});
    for (const auto& workspace : json.value("stopped", Json::array()))
      state.stopped[workspace.get<std::string>()];
    if (const auto sources = json.find("stopped_by"); sources != json.end())
      sources->get_to(state.stopped);
    state.is_stopping = json.at("status") == "stopping";
    for (const auto& [workspace, mode] : json.at("focus").items())
      state.focus[workspace] = mode.is_null() ? 0 : mode.at("number").get<std::int64_t>();
    for (const auto& host : json.value("hosts", Json::array()))
      visit_host(state.hosts.emplace_back(), FieldReader{host});
    for (const auto& module : json.at("modules"))
      visit_module(state.modules.emplace_back(), FieldReader{module});
    for (const auto& link : json.at("links"))
      visit_link(state.links.emplace_back(), FieldReader{link});
    return state;
  } catch (const Json::exception& error) {
    return Error{Code::Malformed, std::string("the state of a graph: ") + error.what()};
  }
}

}  // namespace hc
