// SPDX-License-Identifier: Apache-2.0
// What modules share: the tables [groups], [modes] and [workspace].
#include <hc/graph/file/tables.h>

namespace hc::internal {

void read_groups(const Fields& fields, const Node& root, Graph& graph) {
  fields.each(root, "groups", [&](const std::string& name, const Node& node) {
    GraphGroup group{name, {}, node.place};
    if (!is_name(name) || name == "all")
      fields.add(node, "a group's name is snake_case and not \"all\", not " + quoted_name(name));
    const auto* list = node.list();
    if (list == nullptr)
      fields.add(node, "a group is a list of inputs, as \"MODULE.PORT\", and addresses");
    else
      for (const Node& member : *list)
        if (auto addressee = fields.addressee(member, "a member of a group"))
          group.members.push_back({*addressee, member.place});
    graph.groups.push_back(std::move(group));
  });
}

void read_modes(const Fields& fields, const Node& root, Graph& graph) {
  fields.each(root, "modes", [&](const std::string& name, const Node& node) {
    const auto* number = node.as<std::int64_t>();
    if (!is_name(name)) fields.add(node, "a mode's name is snake_case, not " + quoted_name(name));
    if (number == nullptr || *number < 1 || *number > 2147483647)
      return fields.add(node, "a mode is a whole number from 1 to 2147483647");
    graph.modes.push_back({name, *number, node.place});
  });
}

void read_workspace(const Fields& fields, const Node& root, Graph& graph) {
  const Node* node = root.find("workspace");
  if (node == nullptr) return;
  graph.workspace = Lined<std::string>{"", node->place};  // until it has a module
  if (node->table() == nullptr) return fields.add(*node, "\"workspace\" is a table");
  fields.check_keys(*node, {"module"}, "in the workspace");
  auto module = fields.text(*node, "module");
  if (!module) return;
  if (module->value.empty()) fields.add(*node->find("module"), "\"module\" is empty");
  graph.workspace = module;
}

}  // namespace hc::internal
