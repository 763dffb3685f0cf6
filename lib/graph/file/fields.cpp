// SPDX-License-Identifier: Apache-2.0
#include <graph/file/fields.h>

#include <algorithm>
#include <cmath>

#include <hc/base/parameter.h>
#include <hc/base/suggestion.h>
#include <hc/base/uri.h>
#include <hc/contract/description.h>

namespace hc::internal {

std::string quoted_name(std::string_view name) {
  return "\"" + std::string(name) + "\"";
}

Result<GraphPort> parse_port(const std::string& text, bool may_be_uri) {
  if (may_be_uri && text.find(':') != std::string::npos) {
    HC_TRY(parse_uri(text));
    return GraphPort{{}, {}, text};
  }
  auto dot = text.find('.');
  if (dot != std::string::npos && is_name(text.substr(0, dot)) && is_name(text.substr(dot + 1)))
    return GraphPort{text.substr(0, dot), text.substr(dot + 1), {}};
  return Error{Code::Invalid, quoted_name(text) + " is not MODULE.PORT"};
}

void Fields::read(const Node& table, const std::string& where, const std::vector<Key>& keys) const {
  if (table.table() == nullptr) return add(table, quoted_name(table.key) + " must be a table");
  const auto known = names_of(keys);
  std::string misspelled;
  for (const Node& value : table.nodes) {
    auto key = std::find(known.begin(), known.end(), value.key);
    if (key == known.end()) {
      const std::string hint = suggestion(value.key, known);
      misspelled += hint;
      add(value, "unknown key \"{}\" {}{}", value.key, where, hint);
    } else if (value.as<Node::Wrong>() == nullptr) {
      keys[static_cast<std::size_t>(key - known.begin())].take(value);
    }
  }
  for (const Key& key : keys)
    if (key.is_required && table.find(key.name) == nullptr &&
        misspelled.find(quoted_name(key.name)) == std::string::npos)
      add(table, quoted_name(key.name) + " is missing " + where);
}

bool Fields::check_name(const Node& node, const std::string& what, std::string_view name) const {
  if (is_name(name)) return true;
  add(node, "{} name \"{}\" is not snake_case", what, name);
  return false;
}

Fields::Take Fields::any_text(Lined<std::string>& to) const {
  return [this, &to](const Node& value) {
    const auto* text = value.as<std::string>();
    if (text == nullptr) return add(value, quoted_name(value.key) + " must be a string");
    to = {*text, value.place};
  };
}

Fields::Take Fields::text(Lined<std::string>& to) const {
  return [this, &to](const Node& value) {
    any_text(to)(value);
    if (const auto* text = value.as<std::string>(); text != nullptr && text->empty())
      add(value, quoted_name(value.key) + " is empty");
  };
}

Fields::Take Fields::text(std::optional<Lined<std::string>>& to) const {
  return [this, &to](const Node& value) {
    Lined<std::string> read;
    text(read)(value);
    if (read.place.line != 0) to = read;
  };
}

Fields::Take Fields::texts(std::vector<Lined<std::string>>& to) const {
  return [this, &to](const Node& value) {
    to.clear();
    one_or_more([&](const Node& each) {
      if (const auto* text = each.as<std::string>())
        to.push_back({*text, each.place});
      else
        add(each, quoted_name(value.key) + " must be a list of strings");
    })(value);
  };
}

Fields::Take Fields::integer(Lined<std::int64_t>& to, std::int64_t min, std::int64_t max) const {
  return [this, &to, min, max](const Node& value) {
    const auto* number = value.as<std::int64_t>();
    if (number == nullptr || *number < min || *number > max)
      return add(value, "\"{}\" must be a whole number from {} to {}", value.key, min, max);
    to = {*number, value.place};
  };
}

Fields::Take Fields::flag(bool& to) const {
  return [this, &to](const Node& value) {
    if (const auto* flag = value.as<bool>())
      to = *flag;
    else
      add(value, quoted_name(value.key) + " must be true or false");
  };
}

Fields::Take Fields::numbers(std::array<double, 3>& to) const {
  return [this, &to](const Node& value) {
    bool is_right = value.list() != nullptr && value.nodes.size() == to.size();
    for (std::size_t i = 0; is_right && i < to.size(); ++i) {
      const auto* real = value.nodes[i].as<double>();
      const auto* whole = value.nodes[i].as<std::int64_t>();
      is_right = whole != nullptr || (real != nullptr && std::isfinite(*real));
      if (is_right) to[i] = real != nullptr ? *real : static_cast<double>(*whole);
    }
    if (!is_right) add(value, quoted_name(value.key) + " must be a list of 3 numbers");
  };
}

Fields::Take Fields::choice(std::vector<std::string> words,
                            std::function<void(const Node&, std::size_t)> take) const {
  return [this, words = std::move(words), take = std::move(take)](const Node& value) {
    const auto* text = value.as<std::string>();
    auto found = std::find(words.begin(), words.end(), text == nullptr ? "" : *text);
    if (found != words.end()) return take(value, static_cast<std::size_t>(found - words.begin()));
    std::string all;
    for (std::size_t i = 0; i < words.size(); ++i)
      all += (i == 0 ? "" : i + 1 == words.size() ? " or " : ", ") + quoted_name(words[i]);
    add(value, "\"{}\" must be {}{}", value.key, all,
        text == nullptr ? "" : suggestion(*text, words));
  };
}

Fields::Take Fields::each(Take take) const {
  return [this, take = std::move(take)](const Node& table) {
    if (table.table() == nullptr) return add(table, quoted_name(table.key) + " must be a table");
    for (const Node& value : table.nodes)
      if (value.as<Node::Wrong>() == nullptr) take(value);
  };
}

Fields::Take Fields::one_or_more(Take take) {
  return [take = std::move(take)](const Node& value) {
    if (value.list() == nullptr) return take(value);
    for (const Node& each : value.nodes) take(each);
  };
}

std::optional<std::string> Fields::scalar(const Node& node) {
  if (const auto* text = node.as<std::string>()) return *text;
  if (const auto* flag = node.as<bool>()) return std::string(*flag ? "true" : "false");
  if (const auto* number = node.as<std::int64_t>()) return std::to_string(*number);
  if (const auto* number = node.as<double>()) return hc::text(*number);
  return std::nullopt;
}

}  // namespace hc::internal
