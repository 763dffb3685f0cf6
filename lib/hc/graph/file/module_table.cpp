// SPDX-License-Identifier: Apache-2.0
// The table [modules.NAME].
#include <sstream>

#include <hc/base/suggestion.h>
#include <hc/graph/file/tables.h>

namespace hc::internal {
namespace {

constexpr double kMostIdleRate = 1e6;  // [Hz]

std::optional<Lined<std::string>> read_idle_rate(const Fields& fields, const Node& table) {
  const Node* node = table.find("idle_rate");
  if (node == nullptr) return std::nullopt;
  std::optional<double> rate;
  if (const auto* number = node->as<double>()) rate = *number;
  if (const auto* number = node->as<std::int64_t>()) rate = static_cast<double>(*number);
  if (rate && *rate >= 0 && *rate <= kMostIdleRate)
    return Lined<std::string>{*fields.parameter(*node), node->place};
  fields.add(*node, "\"idle_rate\" is a number from 0 to 1000000 [Hz]");
  return std::nullopt;
}

void read_module(const Fields& fields, const std::string& name, const Node& node, Restart restart,
                 Graph& graph) {
  GraphModule& module = graph.modules.emplace_back();
  module.name = module.program = name;
  module.place = node.place;
  if (!is_name(name))
    fields.add(node, "a module's name is snake_case, not " + quoted_name(module.name));
  if (node.table() == nullptr)
    return fields.add(node, "a module is a table [modules." + name + "]");
  fields.check_keys(node,
                    {"program", "parameters", "addresses", "encodings", "to", "restart", "mode",
                     "modes", "idle_rate", "exclusive", "ends_graph"},
                    "in module " + name);
  if (const Node* program = node.find("program")) {
    module.program = fields.text(node, "program").value_or(Lined<std::string>()).value;
    if (module.program.empty() && program->as<std::string>() != nullptr)
      fields.add(*program, "\"program\" is empty");
  } else if (!is_name(name)) {
    module.program.clear();  // the name has been told
  }
  fields.each(node, "parameters", [&](const std::string& key, const Node& value) {
    if (auto text = fields.parameter(value)) module.parameters[key] = {*text, value.place};
  });
  fields.each(node, "addresses", [&](const std::string& key, const Node& value) {
    const auto* address = value.as<std::int64_t>();
    if (address == nullptr || *address < 0 || *address > 2147483647)
      return fields.add(value, "an address is a whole number from 0 to 2147483647");
    module.addresses[key] = {*address, value.place};
  });
  fields.each(node, "encodings", [&](const std::string& key, const Node& value) {
    const auto* text = value.as<std::string>();
    auto encoding = encoding_of(text == nullptr ? "" : *text);
    if (!encoding) return fields.add(value, R"(an encoding is "text", "binary", "zstd" or "jpeg")");
    module.encodings[key] = {*encoding, value.place};
  });
  fields.each(node, "to", [&](const std::string& key, const Node& value) {
    if (auto to = fields.addressee(value, quoted_name("to"))) module.to[key] = {*to, value.place};
  });
  module.restart = read_restart(fields, node, restart);
  module.mode = fields.text_if_there(node, "mode");
  module.modes = fields.texts(node, "modes");
  module.idle_rate = read_idle_rate(fields, node);
  module.exclusive = fields.texts(node, "exclusive");
  if (const Node* ends = node.find("ends_graph")) {
    const auto* flag = ends->as<bool>();
    if (flag == nullptr) return fields.add(*ends, R"("ends_graph" is true or false)");
    module.ends_graph = *flag;
  }
}

}  // namespace

Restart read_restart(const Fields& fields, const Node& table, Restart default_value) {
  const Node* node = table.find("restart");
  if (node == nullptr) return default_value;
  const auto* text = node->as<std::string>();
  const std::string word = text == nullptr ? "" : *text;
  if (word == "never") return Restart::Never;
  if (word == "failure") return Restart::Failure;
  if (word == "always") return Restart::Always;
  fields.add(*node, R"("restart" is "never", "failure" or "always")" +
                        suggestion(word, {"never", "failure", "always"}));
  return default_value;
}

void read_modules(const Fields& fields, const Node& root, Restart restart, Graph& graph) {
  const Node* modules = root.find("modules");
  if (modules == nullptr) {
    if (!Fields::misspells(root, "modules") && root.find("graphs") == nullptr)
      fields.add(root, "a graph has a table [modules.NAME] for each module");
  } else if (const auto* table = modules->table()) {
    for (const Node& node : *table) read_module(fields, node.key, node, restart, graph);
  } else {
    fields.add(root, "a graph has a table [modules.NAME] for each module");
  }
}

}  // namespace hc::internal
