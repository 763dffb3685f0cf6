// SPDX-License-Identifier: Apache-2.0
#include "catalog.h"

#include <algorithm>
#include <set>
#include <utility>

#include <ros/type_for.h>

namespace {

std::string topic_of(std::string port) {
  std::ranges::replace(port, '.', '/');
  return "/" + port;
}

Json list_of(const std::map<std::string, std::vector<std::string>>& names, const char* key) {
  Json list = Json::array();
  for (const auto& [topic, modules] : names) list.push_back({{"name", topic}, {key, modules}});
  return list;
}

Json value_of(const hc::ParameterState& parameter) {
  return std::visit([](const auto& value) { return Json(value); }, parameter.value);
}

}  // namespace

Catalog::Catalog(bool jpeg) : jpeg_(jpeg) {
  channels_[kLog] = {kLog, "/log", "", hc::ros::Type::Log};
  channels_[kFrames] = {kFrames, "/tf", "", hc::ros::Type::TfMessage};
}

Catalog::Changes Catalog::take_state(const hc::GraphState& state) {
  Changes changes;
  std::set<std::string> there;
  for (const auto& module : state.modules) {
    there.insert(module.name);
    const auto [known, is_new] = programs_.try_emplace(module.name, module.program);
    if (is_new || known->second != module.program) {
      remove_outputs(module.name, changes);
      known->second = module.program;
      changes.unknown.push_back(module.name);
    }
    for (const auto& [key, text] : module.parameters) {
      const std::string name = module.name + "." + key;
      if (values_[name] == text) continue;
      values_[name] = text;
      const auto parameter = parameters_.find(name);
      if (parameter != parameters_.end() && parameter->second.set(text))
        changes.parameters.push_back(name);
    }
  }
  std::erase_if(programs_, [&](const auto& known) {
    if (there.contains(known.first)) return false;
    remove_outputs(known.first, changes);
    return true;
  });
  Names published, taken;
  auto module_of = [](const std::string& port) { return port.substr(0, port.find('.')); };
  for (const auto& link : state.links) {
    if (!there.contains(module_of(link.from))) continue;  // from outside
    published[topic_of(link.from)] = {module_of(link.from)};
    if (there.contains(module_of(link.to)))
      taken[topic_of(link.from)].push_back(module_of(link.to));
  }
  changes.graph = published != published_ || taken != taken_;
  published_ = std::move(published);
  taken_ = std::move(taken);
  return changes;
}

Catalog::Changes Catalog::describe(const std::string& module, std::string_view description) {
  Changes changes;
  const auto described = hc::parse_description(description);
  if (!programs_.contains(module) || !described) return changes;
  remove_outputs(module, changes);
  for (const auto& output : described->outputs) {
    const std::string port = module + "." + output.name;
    const auto type = hc::ros::type_for(output, jpeg_).value_or(hc::ros::Type::Matrix);
    changes.added.push_back({next_++, topic_of(port), port, type});
    channels_[changes.added.back().id] = changes.added.back();
  }
  for (const auto& parameter : described->parameters) {
    auto& state = parameters_[module + "." + parameter.name] = parameter;
    const auto value = values_.find(module + "." + parameter.name);
    if (value != values_.end()) static_cast<void>(state.set(value->second));
  }
  return changes;
}

void Catalog::remove_outputs(const std::string& module, Changes& changes) {
  const std::string prefix = module + ".";
  std::erase_if(channels_, [&](const auto& each) {
    if (!each.second.port.starts_with(prefix)) return false;
    changes.removed.push_back(each.second);
    return true;
  });
  std::erase_if(parameters_, [&](const auto& each) { return each.first.starts_with(prefix); });
}

std::string Catalog::advertise(const std::vector<Channel>& channels) {
  Json list = Json::array();
  for (const auto& channel : channels) {
    const auto& schema = hc::ros::schema(channel.type);
    list.push_back({{"id", channel.id},
                    {"topic", channel.topic},
                    {"encoding", "cdr"},
                    {"schemaName", schema.name},
                    {"schemaEncoding", "ros2msg"},
                    {"schema", schema.text}});
  }
  return text(Json{{"op", "advertise"}, {"channels", std::move(list)}});
}

std::string Catalog::unadvertise(const std::vector<Channel>& channels) {
  Json list = Json::array();
  for (const auto& channel : channels) list.push_back(channel.id);
  return text(Json{{"op", "unadvertise"}, {"channelIds", std::move(list)}});
}

std::string Catalog::connection_graph() const {
  return text(Json{{"op", "connectionGraphUpdate"},
                   {"publishedTopics", list_of(published_, "publisherIds")},
                   {"subscribedTopics", list_of(taken_, "subscriberIds")},
                   {"advertisedServices", Json::array()},
                   {"removedTopics", Json::array()},
                   {"removedServices", Json::array()}});
}

std::string Catalog::parameter_values(const std::vector<std::string>& names, const std::string& id,
                                      const std::map<std::string, std::string>& set) const {
  Json list = Json::array();
  for (const auto& name : std::set<std::string>(names.begin(), names.end())) {
    const auto found = parameters_.find(name);
    if (found == parameters_.end()) continue;
    hc::ParameterState parameter = found->second;
    if (const auto value = set.find(name); value != set.end())
      static_cast<void>(parameter.set(value->second));
    Json each = {{"name", name}, {"value", value_of(parameter)}};
    const bool is_number = std::holds_alternative<std::int64_t>(parameter.value) ||
                           std::holds_alternative<double>(parameter.value);
    if (is_number) each["type"] = "float64";
    list.push_back(std::move(each));
  }
  Json values = {{"op", "parameterValues"}, {"parameters", std::move(list)}};
  if (!id.empty()) values["id"] = id;
  return text(values);
}

std::vector<std::string> Catalog::parameter_names() const {
  std::vector<std::string> names;
  for (const auto& [name, parameter] : parameters_) names.push_back(name);
  return names;
}
