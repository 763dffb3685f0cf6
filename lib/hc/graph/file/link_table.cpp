// SPDX-License-Identifier: Apache-2.0
// The tables [[links]].
#include <hc/graph/file/tables.h>
#include <hc/link/policy.h>

namespace hc::internal {
namespace {

std::optional<GraphPort> read_end(const Fields& fields, const Node& table, std::string_view key) {
  auto text = fields.text(table, key);
  if (!text) return std::nullopt;
  return fields.port(*table.find(key), text->value, true);
}

void read_policy(const Fields& fields, const Node& table, const std::vector<std::string>& keys,
                 GraphLink& link) {
  Uri policy;  // of the keys so far: each burst stands behind its rate in `keys`
  // What is wrong has been told, so that it stands as empty, and as right for what needs it.
  auto refuse = [&](const Node& value, std::string& text, std::string what) {
    fields.add(value, std::move(what));
    text.clear();
    policy.options.back().second = "1";
    if (!parse_policy(policy)) policy.options.pop_back();
  };
  for (const auto& key : keys) {
    const Node* value = table.find(key);
    if (value == nullptr) continue;
    std::string text;
    if (const auto* number = value->as<std::int64_t>()) {
      text = std::to_string(*number);
    } else if (const auto* given = value->as<std::string>()) {
      text = *given;
    }
    policy.options.emplace_back(key, text);
    if (value->as<std::int64_t>() == nullptr && value->as<std::string>() == nullptr)
      refuse(*value, text, key + " is a whole number or a string");
    else if (text.empty())
      refuse(*value, text, "option " + key + " has no value");
    else if (auto valid = parse_policy(policy); !valid)
      refuse(*value, text, valid.error().detail);
    link.policy[key] = {text, value->place};
  }
}

void read_route(const Fields& fields, const Node& table, GraphLink& link) {
  const Node* node = table.find("route");
  if (node == nullptr) return;
  std::vector<std::int64_t> addresses;
  const auto* word = node->as<std::string>();
  const auto* list = node->list();
  bool is_right = list != nullptr || (word != nullptr && *word == "all");
  link.routes_all = word != nullptr;
  if (list != nullptr)
    for (const Node& each : *list) {
      const auto* number = each.as<std::int64_t>();
      is_right = is_right && number != nullptr && std::abs(*number) <= 2147483647;
      if (number != nullptr) addresses.push_back(*number);
    }
  if (!is_right) fields.add(*node, R"("route" is a list of addresses, or "all")");
  link.route = {std::move(addresses), node->place};
}

void read_link(const Fields& fields, const Node& node, Graph& graph) {
  if (node.table() == nullptr) return fields.add(node, "a link is written as [[links]]");
  const std::vector<std::string> policies = {"keep",      "rate",       "burst",
                                             "byte_rate", "byte_burst", "memory"};
  std::vector<std::string> keys = {"from", "to", "route"};
  keys.insert(keys.end(), policies.begin(), policies.end());
  fields.check_keys(node, keys, "in a link");
  auto from = read_end(fields, node, "from"), to = read_end(fields, node, "to");
  GraphLink link;
  link.place = node.place;
  read_policy(fields, node, policies, link);
  read_route(fields, node, link);
  if (!from || !to) return;
  if (!from->uri.empty() && !to->uri.empty())
    return fields.add(node, "a link has a module at one of its ends");
  link.from = *from;
  link.to = *to;
  graph.links.push_back(std::move(link));
}

}  // namespace

void read_links(const Fields& fields, const Node& root, Graph& graph) {
  const Node* links = root.find("links");
  if (links == nullptr) return;
  const auto* list = links->list();
  if (list == nullptr) return fields.add(*links, "links are written as [[links]]");
  for (const Node& node : *list) read_link(fields, node, graph);
}

}  // namespace hc::internal
