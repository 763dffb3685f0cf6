// SPDX-License-Identifier: Apache-2.0
#include <hc/contract/description.h>

#include <algorithm>
#include <cmath>
#include <concepts>
#include <utility>

#include <nlohmann/json.hpp>

#include <hc/contract/trace.h>

namespace hc {
namespace {

using Json = nlohmann::ordered_json;

/// Writes integral numbers without a fraction: 5, not 5.0.
Json number(double value) {
  constexpr double kExact = 9007199254740992;  // 2^53
  if (!std::isfinite(value)) return nullptr;
  if (value == std::trunc(value) && std::abs(value) < kExact)
    return static_cast<std::int64_t>(value);
  return value;
}

Json to_json(const PortType& type) {
  return {{"type", name(type.info.type)},
          {"components", type.info.components},
          {"scalar", name(type.info.scalar)},
          {"width", type.width},
          {"height", type.height},
          {"coord", type.coord}};
}

Json to_json(const PortDescription& port, bool is_output) {
  Json json = {{"name", port.name}, {"types", Json::array()}};
  for (const auto& type : port.types) json["types"].push_back(to_json(type));
  if (port.actor) json["actor"] = true;
  if (port.keep != 0) json["keep"] = port.keep;
  if (is_output && !port.types.empty()) json["encoding"] = name(port.types.front().info.encoding);
  if (!port.columns.empty()) json["columns"] = port.columns;
  json["doc"] = port.doc;
  return json;
}

Json to_json(const ParameterState& parameter) {
  const auto& options = parameter.options;
  Json json = {
      {"name", parameter.name}, {"type", type_name(parameter.value)}, {"unit", parameter.unit}};
  json["default"] = std::visit(
      [](const auto& value) -> Json {
        if constexpr (std::is_same_v<std::decay_t<decltype(value)>, double>)
          return number(value);
        else
          return value;
      },
      parameter.default_value);
  if (std::isfinite(options.min)) json["min"] = number(options.min);
  if (std::isfinite(options.max)) json["max"] = number(options.max);
  if (options.step != 1) json["step"] = options.step;
  if (!options.choices.empty()) json["choices"] = options.choices;
  if (options.fixed) json["fixed"] = true;
  json["doc"] = parameter.doc;
  return json;
}

/// Reads an object key by key; remembers whether one was missing or of the wrong type.
class Reader {
 public:
  explicit Reader(const Json& json) : json_(json), good_(json.is_object()) {}

  template <typename T>
  Reader& need(const char* key, T& value) {
    good_ = good_ && json_.contains(key);
    return read(key, value);
  }
  /// Leaves the value unchanged if the key is absent.
  template <typename T>
  Reader& read(const char* key, T& value) {
    if (good_ && json_.contains(key)) good_ = get(json_.at(key), value);
    return *this;
  }
  [[nodiscard]] bool good() const { return good_; }

 private:
  static bool get(const Json& json, std::string& value) {
    if (json.is_string()) value = json.get<std::string>();
    return json.is_string();
  }
  static bool get(const Json& json, bool& value) {
    if (json.is_boolean()) value = json.get<bool>();
    return json.is_boolean();
  }
  static bool get(const Json& json, double& value) {
    if (json.is_number()) value = json.get<double>();
    return json.is_number();
  }
  template <std::integral Integer>
  static bool get(const Json& json, Integer& value) {
    if (!json.is_number_integer()) return false;
    const auto number = json.get<std::int64_t>();
    value = static_cast<Integer>(number);
    return std::in_range<Integer>(number) && number >= 0;
  }
  static bool get(const Json& json, MatrixType& type) { return get(json, matrix_type_of, type); }
  static bool get(const Json& json, Scalar& scalar) { return get(json, scalar_of, scalar); }
  static bool get(const Json& json, Encoding& encoding) { return get(json, encoding_of, encoding); }
  template <typename Enum>
  static bool get(const Json& json, std::optional<Enum> (*named)(std::string_view), Enum& value) {
    const auto found = json.is_string() ? named(json.get<std::string>()) : std::nullopt;
    value = found.value_or(value);
    return found.has_value();
  }
  static bool get(const Json& json, PortType& type) {
    return Reader(json)
        .need("type", type.info.type)
        .need("components", type.info.components)
        .need("scalar", type.info.scalar)
        .need("width", type.width)
        .need("height", type.height)
        .need("coord", type.coord)
        .good();
  }
  static bool get(const Json& json, PortDescription& port) {
    auto encoding = Encoding::Text;
    const bool good = Reader(json)
                          .need("name", port.name)
                          .need("types", port.types)
                          .read("doc", port.doc)
                          .read("actor", port.actor)
                          .read("keep", port.keep)
                          .read("columns", port.columns)
                          .read("encoding", encoding)
                          .good();
    for (auto& type : port.types) type.info.encoding = encoding;
    return good;
  }
  static bool get(const Json& json, ParameterState& parameter) {
    std::string type;
    auto& options = parameter.options;
    const bool good = Reader(json)
                          .need("name", parameter.name)
                          .need("type", type)
                          .read("unit", parameter.unit)
                          .read("doc", parameter.doc)
                          .read("min", options.min)
                          .read("max", options.max)
                          .read("step", options.step)
                          .read("choices", options.choices)
                          .read("fixed", options.fixed)
                          .good();
    if (!good || options.step < 1) return false;
    if (type == "integer") parameter.value = std::int64_t{0};
    if (type == "number") parameter.value = 0.0;
    if (type == "string") parameter.value = std::string();
    const bool has_default = json.contains("default") && !json["default"].is_null();
    if (has_default)
      std::visit([&](auto& value) { static_cast<void>(get(json["default"], value)); },
                 parameter.value);
    parameter.default_value = parameter.value;
    return type == type_name(parameter.value);
  }
  template <typename T>
  static bool get(const Json& json, std::vector<T>& list) {
    return json.is_array() && std::all_of(json.begin(), json.end(), [&](const Json& each) {
             return get(each, list.emplace_back());
           });
  }
  template <typename T>
  static bool get(const Json& json, std::optional<T>& value) {
    return get(json, value.emplace());
  }

  const Json& json_;
  bool good_;
};

/// `own` if the module has it, as all with `control` do, and the name matches.
const PortDescription* implicit(const Description& description, const PortDescription& own,
                                std::string_view port) {
  return description.control && port == own.name ? &own : nullptr;
}

}  // namespace

bool Description::knows(std::string_view transport) const {
  if (!transports) return transport != "shm" && transport != "inproc";
  return std::find(transports->begin(), transports->end(), transport) != transports->end();
}

std::string in_words(const PortDescription& port) {
  std::string text = in_words(port.types);
  for (const auto& column : port.columns)
    text.append(&column == &port.columns.front() ? ": " : ", ").append(column);
  return text;
}

std::string to_json(const Description& description) {
  Json json = {{"name", description.name},    {"summary", description.summary},
               {"inputs", Json::array()},     {"together", description.together},
               {"outputs", Json::array()},    {"parameters", Json::array()},
               {"transports", Json::array()}, {"control", description.control},
               {"routes", description.routes}};
  for (const auto& port : description.inputs) json["inputs"].push_back(to_json(port, false));
  for (const auto& port : description.outputs) json["outputs"].push_back(to_json(port, true));
  for (const auto& each : description.parameters) json["parameters"].push_back(to_json(each));
  if (description.transports)
    json["transports"] = *description.transports;
  else
    json.erase("transports");
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::optional<Description> parse_description(std::string_view text) {
  const Json json = Json::parse(text, nullptr, false);
  Description description;
  const bool good = Reader(json)
                        .read("name", description.name)
                        .read("summary", description.summary)
                        .need("inputs", description.inputs)
                        .need("outputs", description.outputs)
                        .need("parameters", description.parameters)
                        .read("together", description.together)
                        .read("transports", description.transports)
                        .read("control", description.control)
                        .read("routes", description.routes)
                        .good();
  if (!good) return std::nullopt;
  return description;
}

bool is_name(std::string_view text) {
  auto is_letter = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
  };
  return !text.empty() && text.size() <= 64 && text.front() >= 'a' && text.front() <= 'z' &&
         std::all_of(text.begin(), text.end(), is_letter);
}

bool is_port_name(std::string_view text) {
  const auto dot = std::min(text.find('.'), text.size());
  return is_name(text.substr(0, dot)) && dot < text.size() && is_name(text.substr(dot + 1));
}

Status check_names(const Description& description) {
  for (const auto* ports : {&description.inputs, &description.outputs})
    for (const auto& port : *ports)
      if (!is_name(port.name))
        return Error{Code::Invalid, std::string(ports == &description.inputs ? "input" : "output") +
                                        " name \"" + port.name + "\" is not snake_case"};
  return {};
}

const PortDescription& focus_input() {
  static const PortDescription kFocus{
      "focus", "", {{{MatrixType::Table, 1, Scalar::I32, Encoding::Text}, 1, 1, 0}}, false, 1};
  return kFocus;
}

const PortDescription& trace_output() {
  static const PortDescription kTrace{
      kTracePort, "", {{{MatrixType::String, 1, Scalar::U8, Encoding::Binary}, 0, 0, 0}}};
  return kTrace;
}

const PortDescription* find_output(const Description& description, std::string_view port) {
  const auto* found = find_named(description.outputs, port);
  return found != nullptr ? found : implicit(description, trace_output(), port);
}

const PortDescription* find_input(const Description& description, std::string_view port) {
  const auto* found = find_named(description.inputs, port);
  return found != nullptr ? found : implicit(description, focus_input(), port);
}

}  // namespace hc
