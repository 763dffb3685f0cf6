// SPDX-License-Identifier: Apache-2.0
#include <hc/graph/plan/description.h>

#include <algorithm>

#include <nlohmann/json.hpp>

namespace hc::internal {
namespace {

using Json = nlohmann::json;

/// Whether a program has said of itself what is needed of it here.
bool is_description(const Json& json) {
  auto all = [](const Json& list, auto is_right) {
    return list.is_array() && std::all_of(list.begin(), list.end(), is_right);
  };
  auto has = [](const Json& object, const char* key, auto is_right) {
    return object.is_object() && object.contains(key) && is_right(object[key]);
  };
  auto if_there = [](const Json& object, const char* key, auto is_right) {
    return !object.contains(key) || is_right(object[key]);
  };
  auto is_text = [](const Json& value) { return value.is_string(); };
  auto is_number = [](const Json& value) { return value.is_number(); };
  auto is_step = [](const Json& value) { return value.is_number_integer() && value >= 1; };
  auto is_flag = [](const Json& value) { return value.is_boolean(); };
  auto is_type = [&](const Json& type) {
    return has(type, "type", is_text) && has(type, "scalar", is_text) &&
           has(type, "components", is_number) && has(type, "width", is_number) &&
           has(type, "height", is_number) && has(type, "coord", is_number);
  };
  auto is_port = [&](const Json& port) {
    return has(port, "name", is_text) && if_there(port, "actor", is_flag) &&
           has(port, "types", [&](const Json& types) { return all(types, is_type); });
  };
  auto is_parameter = [&](const Json& parameter) {
    return has(parameter, "name", is_text) && has(parameter, "type", is_text) &&
           if_there(parameter, "min", is_number) && if_there(parameter, "max", is_number) &&
           if_there(parameter, "step", is_step) && if_there(parameter, "fixed", is_flag) &&
           if_there(parameter, "choices", [&](const Json& list) { return all(list, is_text); });
  };
  return has(json, "inputs", [&](const Json& list) { return all(list, is_port); }) &&
         has(json, "outputs", [&](const Json& list) { return all(list, is_port); }) &&
         has(json, "parameters", [&](const Json& list) { return all(list, is_parameter); }) &&
         if_there(json, "control", is_flag) && if_there(json, "routes", is_flag);
}

std::vector<DescribedPort> ports_from(const Json& list) {
  std::vector<DescribedPort> ports;
  for (const auto& json : list) {
    DescribedPort& port = ports.emplace_back();
    port.name = json.at("name");
    port.actor = json.value("actor", false);
    for (const auto& type : json.at("types"))
      port.types.push_back({type.at("type"), type.at("scalar"), type.at("components"),
                            type.at("width"), type.at("height"), type.at("coord")});
  }
  return ports;
}

DescribedParameter parameter_from(const Json& json) {
  DescribedParameter parameter;
  ParameterState& state = parameter.state;
  state.name = json.at("name");
  const std::string type = json.at("type");
  if (type == "bool") state.value = false;
  if (type == "integer") state.value = std::int64_t{0};
  if (type == "number") state.value = 0.0;
  if (type == "string") state.value = std::string();
  state.options.min = json.value("min", state.options.min);
  state.options.max = json.value("max", state.options.max);
  state.options.step = json.value("step", state.options.step);
  state.options.choices = json.value("choices", state.options.choices);
  parameter.fixed = json.value("fixed", false);
  return parameter;
}

bool type_fits(const DescribedType& given, const DescribedType& taken) {
  auto same = [](std::int64_t a, std::int64_t b) { return a == 0 || b == 0 || a == b; };
  return given.type == taken.type && given.scalar == taken.scalar &&
         given.components == taken.components && same(given.width, taken.width) &&
         same(given.height, taken.height) && same(given.coord, taken.coord);
}

}  // namespace

bool Description::knows(std::string_view transport) const {
  if (!transports) return transport != "shm" && transport != "inproc";
  return std::find(transports->begin(), transports->end(), transport) != transports->end();
}

std::optional<Description> parse_description(std::string_view text) {
  const Json json = Json::parse(text, nullptr, false);
  if (!is_description(json)) return std::nullopt;
  Description description;
  description.inputs = ports_from(json["inputs"]);
  description.outputs = ports_from(json["outputs"]);
  for (const auto& each : json["parameters"])
    description.parameters.push_back(parameter_from(each));
  description.control = json.value("control", false);
  description.routes = json.value("routes", false);
  if (json.contains("transports")) {
    description.transports.emplace();
    for (const auto& each : json["transports"])
      if (each.is_string()) description.transports->push_back(each);
  }
  return description;
}

const DescribedPort& focus_input() {
  static const DescribedPort kFocus{"focus", {{"table", "i32", 1, 1, 1, 0}}, false};
  return kFocus;
}

const DescribedPort* find_input(const Description& description, std::string_view port) {
  const DescribedPort* found = find_named(description.inputs, port);
  if (found == nullptr && description.control && port == focus_input().name) return &focus_input();
  return found;
}

const DescribedPort* find_output(const Description& description, std::string_view port) {
  return find_named(description.outputs, port);
}

std::vector<std::string> names_of(const std::vector<DescribedPort>& ports) {
  std::vector<std::string> names;
  names.reserve(ports.size());
  for (const auto& each : ports) names.push_back(each.name);
  return names;
}

std::vector<std::string> names_of(const std::vector<DescribedParameter>& parameters) {
  std::vector<std::string> names;
  names.reserve(parameters.size());
  for (const auto& each : parameters) names.push_back(each.state.name);
  return names;
}

bool fits(const DescribedPort& output, const DescribedPort& input) {
  if (output.types.empty() || input.types.empty()) return true;
  return std::any_of(input.types.begin(), input.types.end(), [&](const DescribedType& taken) {
    return type_fits(output.types.front(), taken);
  });
}

std::string in_words(const std::vector<DescribedType>& types) {
  std::string text;
  for (const auto& type : types) {
    if (!text.empty()) text += " or ";
    text += type.type + " " + std::to_string(type.components) + " x " + type.scalar;
    if (type.coord != 0) text += " in coordinate system " + std::to_string(type.coord);
  }
  return text;
}

Info info_from(const DescribedType& type, Encoding encoding) {
  return {matrix_type_of(type.type).value_or(MatrixType{}),
          static_cast<std::uint8_t>(type.components), scalar_of(type.scalar).value_or(Scalar::F64),
          encoding};
}

}  // namespace hc::internal
