// SPDX-License-Identifier: Apache-2.0
// --help and --describe.
#include <hc/base/format.h>
#include <hc/link/link.h>
#include <hc/module/arguments.h>

namespace hc::internal {
namespace {

std::string line(const std::string& left, const std::string& right) {
  return hc::format("  {:<25} {}\n", left, right);
}

std::string lines(const std::string& title, const std::vector<PortDescription>& ports) {
  std::string text = ports.empty() ? "" : "\n" + title + ":\n";
  for (const auto& port : ports) text += line(port.name, port.doc + " (" + in_words(port) + ")");
  return text;
}

std::string parameter_line(const ParameterState& parameter) {
  std::string left = (parameter.options.positional ? "[--" : "--") + parameter.name +
                     (parameter.options.positional ? "]" : "");
  std::string right = parameter.doc;
  if (!parameter.unit.empty()) right += " [" + parameter.unit + "]";
  for (const auto& choice : parameter.options.choices)
    right += (&choice == &parameter.options.choices.front() ? ": " : ", ") + choice;
  const std::string range = range_in_words(parameter.options);
  std::string default_value = text(parameter.default_value);
  return line(left, right + " (" + range + (range.empty() ? "" : "; ") + "default " +
                        (default_value.empty() ? "none" : default_value) + ")");
}

}  // namespace

Description description_of(const Module& module) {
  Description description;
  description.name = module.name();
  description.summary = ModuleAccess::summary(module);
  for (const auto& port : ModuleAccess::inputs(module))
    description.inputs.push_back(
        {port->name, port->doc, port->types, port->options.actor, port->options.keep});
  for (const auto& port : ModuleAccess::outputs(module))
    description.outputs.push_back(
        {port->name, port->doc, port->types, false, 0, port->options.columns});
  for (const auto& together : ModuleAccess::together(module)) {
    auto& names = description.together.emplace_back();
    for (const auto& port : together->inputs) names.push_back(port->name);
  }
  for (const auto& parameter : ModuleAccess::parameters(module))
    description.parameters.push_back(*parameter);
  const auto schemes = transports();
  description.transports.emplace(schemes.begin(), schemes.end());
  description.control = true;
  description.routes = ModuleAccess::routes(module);
  return description;
}

std::string help(const Module& module) {
  const Description description = description_of(module);
  std::string text =
      ModuleAccess::summary(module) + "\n\nUsage: hc " + module.name() + " [OPTION …]\n";
  text += lines("Inputs", description.inputs);
  for (const auto& together : description.together) {
    std::string names;
    for (const auto& name : together) names += (names.empty() ? "" : ", ") + name;
    text += "  Taken together, by their times: " + names + "\n";
  }
  text += lines("Outputs", description.outputs);
  if (!description.parameters.empty()) text += "\nParameters:\n";
  for (const auto& parameter : description.parameters) text += parameter_line(parameter);
  text += "\nLinks and common options:\n";
  for (const auto& [option, doc] : options_of(module)) text += line(option, doc);
  return text;
}

}  // namespace hc::internal
