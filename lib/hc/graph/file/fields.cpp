// SPDX-License-Identifier: Apache-2.0
#include <hc/graph/file/fields.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include <hc/base/suggestion.h>
#include <hc/base/uri.h>

namespace hc::internal {

bool is_name(std::string_view text) {
  auto is_letter = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
  };
  return !text.empty() && text.size() <= 64 && text.front() >= 'a' && text.front() <= 'z' &&
         std::all_of(text.begin(), text.end(), is_letter);
}

std::string quoted_name(std::string_view name) {
  return "\"" + std::string(name) + "\"";
}

void Fields::check_keys(const Node& table, const std::vector<std::string>& known,
                        const std::string& where) const {
  for (const Node& node : *table.table())
    if (std::find(known.begin(), known.end(), node.key) == known.end())
      add(node, "no key " + quoted_name(node.key) + " " + where + suggestion(node.key, known));
}

bool Fields::misspells(const Node& table, std::string_view key) {
  return std::any_of(table.nodes.begin(), table.nodes.end(), [&](const Node& node) {
    return !suggestion(node.key, {std::string(key)}).empty();
  });
}

void Fields::each(const Node& parent, std::string_view key,
                  const std::function<void(const std::string&, const Node&)>& take) const {
  const Node* node = parent.find(key);
  if (node == nullptr) return;
  const auto* table = node->table();
  if (table == nullptr) return add(*node, quoted_name(key) + " is a table");
  for (const Node& value : *table) take(value.key, value);
}

std::optional<Lined<std::string>> Fields::text_if_there(const Node& parent,
                                                        std::string_view key) const {
  return parent.find(key) == nullptr ? std::nullopt : text(parent, key);
}

std::optional<Lined<std::string>> Fields::text(const Node& parent, std::string_view key) const {
  const Node* node = parent.find(key);
  if (node == nullptr) {
    if (!misspells(parent, key)) add(parent, quoted_name(key) + " is missing");
    return std::nullopt;
  }
  if (const auto* text = node->as<std::string>()) return Lined<std::string>{*text, node->place};
  add(*node, quoted_name(key) + " is a string");
  return std::nullopt;
}

std::vector<Lined<std::string>> Fields::texts(const Node& parent, std::string_view key) const {
  const Node* node = parent.find(key);
  if (node == nullptr) return {};
  std::vector<Lined<std::string>> all;
  auto take = [&](const Node& each) {
    if (const auto* text = each.as<std::string>())
      all.push_back({*text, each.place});
    else
      add(each, quoted_name(key) + " is a list of strings");
  };
  if (const auto* list = node->list())
    std::for_each(list->begin(), list->end(), take);
  else
    take(*node);
  return all;
}

std::optional<std::vector<double>> Fields::numbers(const Node& parent, std::string_view key,
                                                   std::size_t count) const {
  const Node* node = parent.find(key);
  if (node == nullptr) return std::nullopt;
  std::vector<double> all;
  if (const auto* list = node->list()) {
    for (const Node& each : *list) {
      if (const auto* number = each.as<double>()) all.push_back(*number);
      if (const auto* number = each.as<std::int64_t>()) all.push_back(static_cast<double>(*number));
    }
    bool is_right = all.size() == count && list->size() == count &&
                    std::all_of(all.begin(), all.end(), [](double x) { return std::isfinite(x); });
    if (is_right) return all;
  }
  add(*node, quoted_name(key) + " is a list of " + std::to_string(count) + " numbers");
  return std::nullopt;
}

std::optional<std::string> Fields::parameter(const Node& node) const {
  if (const auto* text = node.as<std::string>()) return expand(node, *text);
  if (const auto* flag = node.as<bool>()) return std::string(*flag ? "true" : "false");
  if (const auto* number = node.as<std::int64_t>()) return std::to_string(*number);
  if (const auto* number = node.as<double>()) {
    std::ostringstream text;
    text.precision(17);
    text << *number;
    return text.str();
  }
  add(node, "a parameter is a string, a number, true or false");
  return std::nullopt;
}

std::optional<Addressee> Fields::addressee(const Node& node, std::string_view what) const {
  constexpr std::int64_t kMost = 2147483647;
  const auto* number = node.as<std::int64_t>();
  if (number != nullptr && *number != 0 && *number >= -kMost && *number <= kMost)
    return Addressee{{}, *number};
  const auto* text = node.as<std::string>();
  if (text != nullptr && !text->empty()) return Addressee{*text, 0};
  add(node,
      std::string(what) + " is an address from -2147483647 to 2147483647 without 0, or a name");
  return std::nullopt;
}

std::optional<GraphPort> Fields::port(const Node& node, const std::string& text,
                                      bool may_be_uri) const {
  if (may_be_uri && text.find(':') != std::string::npos) {
    if (auto uri = parse_uri(text); !uri) {
      add(node, uri.error().detail);
      return std::nullopt;
    }
    return GraphPort{{}, {}, text};
  }
  auto dot = text.find('.');
  if (dot != std::string::npos && is_name(text.substr(0, dot)) && is_name(text.substr(dot + 1)))
    return GraphPort{text.substr(0, dot), text.substr(dot + 1), {}};
  add(node, quoted_name(text) + " is not MODULE.PORT");
  return std::nullopt;
}

/// Puts variables of the environment in.
std::optional<std::string> Fields::expand(const Node& node, std::string_view text) const {
  std::string result;
  bool is_right = true;
  auto refuse = [&](std::string what) {
    add(node, std::move(what));
    is_right = false;
  };
  while (true) {
    auto begin = text.find("${");
    result += text.substr(0, begin);
    if (begin == std::string_view::npos) return is_right ? std::optional(result) : std::nullopt;
    auto end = text.find('}', begin);
    if (end == std::string_view::npos) {
      add(node, "no } after ${");
      return std::nullopt;
    }
    std::string variable{text.substr(begin + 2, end - begin - 2)};
    text.remove_prefix(end + 1);
    std::optional<std::string> default_value;
    if (auto split = variable.find(":-"); split != std::string::npos) {
      default_value = variable.substr(split + 2);
      variable.resize(split);
    }
    const char* value = environment_(variable.c_str());
    if (variable.empty())
      refuse("no name in ${}, which stands for a variable of the environment");
    else if (value == nullptr && !default_value)
      refuse("the environment has no variable " + variable + "; ${" + variable +
             ":-VALUE} gives a default");
    result += value != nullptr && *value != '\0' ? value : default_value.value_or("");
  }
}

}  // namespace hc::internal
