// SPDX-License-Identifier: Apache-2.0
// --help and --describe: what a module says of itself.
#include <cmath>

#include <hc/base/json_string.h>
#include <hc/module/arguments.h>
#include <hc/mtp/text.h>

namespace hc::internal {
namespace {

std::string in_quotes(std::string_view text) {
  std::string json;
  append_json_string(text, json);
  return json;
}

/// A JSON object that is being written, one key after the other.
class Object {
 public:
  Object& add(std::string_view key, const std::string& json) {
    text_.append(text_.size() > 1 ? "," : "").append(in_quotes(key)).append(":").append(json);
    return *this;
  }
  Object& add_text(std::string_view key, std::string_view text) {
    return add(key, in_quotes(text));
  }
  Object& add_number(std::string_view key, double number) {
    if (!std::isfinite(number)) return *this;
    std::string digits;
    append_number(number, digits);
    return add(key, digits);
  }
  [[nodiscard]] std::string text() const { return text_ + "}"; }

 private:
  std::string text_ = "{";
};

template <typename List, typename Describe>
std::string array(const List& list, Describe describe) {
  std::string text = "[";
  for (const auto& each : list) text.append(text.size() > 1 ? "," : "").append(describe(each));
  return text + "]";
}

std::string describe_type(const PortType& type) {
  return Object()
      .add_text("type", name(type.info.type))
      .add_number("components", type.info.components)
      .add_text("scalar", name(type.info.scalar))
      .add_number("width", type.width)
      .add_number("height", type.height)
      .add_number("coord", type.coord)
      .text();
}

std::string value_as_json(const ParameterValue& value) {
  const auto* number = std::get_if<double>(&value);
  if (number != nullptr && !std::isfinite(*number)) return "null";
  return std::holds_alternative<std::string>(value) ? in_quotes(text(value)) : text(value);
}

std::string describe_parameter(const ParameterState& parameter) {
  Object object;
  object.add_text("name", parameter.name)
      .add_text("type", type_name(parameter.value))
      .add_text("unit", parameter.unit)
      .add("default", value_as_json(parameter.default_value))
      .add_number("min", parameter.options.min)
      .add_number("max", parameter.options.max);
  if (parameter.options.step != 1) object.add("step", std::to_string(parameter.options.step));
  if (!parameter.options.choices.empty())
    object.add("choices", array(parameter.options.choices,
                                [](const std::string& choice) { return in_quotes(choice); }));
  if (parameter.options.fixed) object.add("fixed", "true");
  return object.add_text("doc", parameter.doc).text();
}

std::string line(const std::string& left, const std::string& right) {
  constexpr std::size_t kColumn = 28;
  std::string pad(left.size() + 3 < kColumn ? kColumn - left.size() - 2 : 1, ' ');
  return "  " + left + pad + right + "\n";
}

std::string parameter_line(const ParameterState& parameter) {
  std::string left = (parameter.options.positional ? "[--" : "--") + parameter.name +
                     (parameter.options.positional ? "]" : "");
  std::string right = parameter.doc;
  if (!parameter.unit.empty()) right += " [" + parameter.unit + "]";
  for (const auto& choice : parameter.options.choices)
    right += (&choice == &parameter.options.choices.front() ? ": " : ", ") + choice;
  std::string default_value = text(parameter.default_value);
  return line(left, right + " (default " + (default_value.empty() ? "none" : default_value) + ")");
}

}  // namespace

std::string describe(const Module& module) {
  auto input = [](const auto& port) {
    Object object;
    object.add_text("name", port->name).add("types", array(port->types, describe_type));
    if (port->is_actor) object.add("actor", "true");
    return object.add_text("doc", port->doc).text();
  };
  auto output = [](const auto& port) {
    Object object;
    object.add_text("name", port->name).add("types", array(port->types, describe_type));
    if (!port->types.empty()) object.add_text("encoding", name(port->type().info.encoding));
    return object.add_text("doc", port->doc).text();
  };
  auto parameter = [](const auto& state) { return describe_parameter(*state); };
  auto together = [](const auto& state) {
    return array(state->inputs, [](const auto& port) { return in_quotes(port->name); });
  };
  return Object()
             .add_text("name", module.name())
             .add_text("summary", module.summary())
             .add("inputs", array(module.inputs(), input))
             .add("together", array(module.together(), together))
             .add("outputs", array(module.outputs(), output))
             .add("parameters", array(module.parameters(), parameter))
             .add("transports", array(transports(), in_quotes))
             .add("control", "true")
             .add("routes", module.routes() ? "true" : "false")
             .text() +
         "\n";
}

std::string help(const Module& module) {
  std::string text = module.summary() + "\n\nUsage: hc " + module.name() + " [OPTION …]\n";
  if (!module.inputs().empty()) text += "\nInputs:\n";
  for (const auto& port : module.inputs())
    text += line(port->name, port->doc + " (" + in_words(port->types) + ")");
  for (const auto& together : module.together()) {
    std::string names;
    for (const auto& port : together->inputs) names += (names.empty() ? "" : ", ") + port->name;
    text += "  Taken together, by their times: " + names + "\n";
  }
  if (!module.outputs().empty()) text += "\nOutputs:\n";
  for (const auto& port : module.outputs())
    text += line(port->name, port->doc + " (" + in_words(port->types) + ")");
  if (!module.parameters().empty()) text += "\nParameters:\n";
  for (const auto& parameter : module.parameters()) text += parameter_line(*parameter);
  text += "\nLinks and common options:\n";
  if (!module.inputs().empty())
    text += line("--in [PORT=]URI", "link an input; without any, inputs share standard input");
  if (!module.outputs().empty()) {
    text += line("--out [PORT=]URI", "link an output; without any, all go to standard output");
    text += line("--address PORT=NUMBER", "the src of an output's messages");
    text += line("--encoding [PORT=]NAME", "text, binary, zstd or jpeg");
    text += line("--to PORT=NUMBER", "the dst of an output's messages");
  }
  text += line("--limit BYTES", "largest elements that are taken (default 268435456)");
  text += line("--name NAME", "what the module is called in its lines");
  text += line("--mode NUMBER", "the system mode of its messages");
  text += line("--modes NUMBER,…", "modes it works in; others idle it");
  text += line("--idle-rate HZ", "what it does while idle (default 0: all)");
  if (!module.inputs().empty())
    text += line("--clock machine|messages", "what tells the time (default machine)");
  text += line("--manage URI", "where its counters go, twice a second");
  text += line("--control URI", "where commands come from, a line each");
  text += line("--describe", "print ports and parameters as JSON");
  return text + line("--help", "print this");
}

}  // namespace hc::internal
