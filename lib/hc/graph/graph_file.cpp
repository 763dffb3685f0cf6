// SPDX-License-Identifier: Apache-2.0
#include <hc/graph/graph_file.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <sstream>

#include <hc/base/suggestion.h>
#include <hc/link/policy.h>

// toml++ before 3.4 asserts, or assumes, what hostile text can break (a line end in a table's
// name), and reports the error right behind it; so it is to go on.
#pragma push_macro("NDEBUG")
#undef NDEBUG
#define TOML_ASSERT(condition) static_cast<void>(0)
#include <toml++/toml.h>
#pragma pop_macro("NDEBUG")

namespace hc {
namespace {

bool is_name(std::string_view text) {
  auto is_letter = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
  };
  return !text.empty() && text.size() <= 64 && text.front() >= 'a' && text.front() <= 'z' &&
         std::all_of(text.begin(), text.end(), is_letter);
}

/// toml++ up to 3.4 runs into undefined behaviour at letters outside ASCII in odd places, so it
/// gets none to see: each of their bytes stands as ~ and two digits, and original() brings it back.
std::string ascii_only(std::string_view text) {
  constexpr std::string_view kHex = "0123456789abcdef";
  std::string result;
  result.reserve(text.size());
  for (char c : text) {
    auto byte = static_cast<unsigned char>(c);
    if (byte < 0x80 && c != '~')
      result += c;
    else
      result.append({'~', kHex[byte >> 4], kHex[byte & 15]});
  }
  return result;
}

/// Where ~ stands as an escape, \u007e, which original() would take for one of ours; npos: nowhere.
std::size_t find_escaped_tilde(std::string_view text) {
  for (std::size_t at = text.find('\\'); at != std::string_view::npos;
       at = text.find('\\', at + 1)) {
    std::string_view escape = text.substr(at + 1, 9);
    if (escape.starts_with('\\')) ++at;  // an escaped backslash
    bool is_tilde = escape.starts_with("u007") ? escape.size() > 4 && (escape[4] | 0x20) == 'e'
                                               : escape == "U0000007e" || escape == "U0000007E";
    if (is_tilde) return at;
  }
  return std::string_view::npos;
}

/// Where the string that opens at `at` has ended; the end of `text` where it does not.
std::size_t skip_string(std::string_view text, std::size_t at) {
  const char quote = text[at];
  const std::string closing(text.substr(at, 3) == std::string(3, quote) ? 3 : 1, quote);
  for (at += closing.size(); at < text.size(); ++at) {
    if (quote == '"' && text[at] == '\\') {
      ++at;  // what is escaped
    } else if (text.substr(at).starts_with(closing)) {
      at += closing.size();
      // Up to two quotes may stand before the three that close.
      for (int more = 0; closing.size() == 3 && more < 2 && at < text.size() && text[at] == quote;
           ++more)
        ++at;
      return at;
    } else if (closing.size() == 1 && text[at] == '\n') {
      return at;
    }
  }
  return text.size();
}

/// Where a key has too many parts, or brackets stand in too many others; npos: nowhere. Each such
/// level is a call within a call of toml++, which so runs out of stack. What is no TOML may be read
/// wrongly here, but only behind where toml++ stops.
std::size_t find_too_deep(std::string_view text) {
  int dots = 0, brackets = 0;
  for (std::size_t at = 0; at < text.size(); ++at) {
    char c = text[at];
    if (c == '#') at = std::min(text.find('\n', at), text.size());
    if (c == '"' || c == '\'') at = skip_string(text, at) - 1;
    if (c == '[' || c == '{') ++brackets;
    if (c == ']' || c == '}') --brackets;
    if (c == '.') ++dots;
    if (std::string_view("=,#\n[{").find(c) != std::string_view::npos) dots = 0;
    if (dots > kMaxGraphDepth || brackets > kMaxGraphDepth) return at;
  }
  return std::string_view::npos;
}

std::string original(std::string_view text) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    unsigned byte = 0;
    bool escaped = text[i] == '~' && i + 2 < text.size() &&
                   std::from_chars(&text[i] + 1, &text[i] + 3, byte, 16).ec == std::errc();
    result += escaped ? static_cast<char>(byte) : text[i];
    if (escaped) i += 2;
  }
  return result;
}

/// Walks through the tables of one file, and goes on behind what is wrong.
class Reader {
 public:
  Reader(const Environment& environment, Problems& problems)
      : environment_(environment), problems_(problems) {
    graph_.file = problems.file();
  }

  Graph read(const toml::table& root) {
    check_keys(root, {"modules", "links"}, "at the top of a graph");
    const toml::node* modules = root.get("modules");
    if (modules != nullptr && modules->is_table()) {
      for (const auto& [key, node] : *modules->as_table()) read_module(original(key.str()), node);
    } else if (modules != nullptr || !root.contains("module")) {
      add(root, "a graph has a table [modules.NAME] for each module");
    }
    if (const toml::node* links = root.get("links")) {
      if (!links->is_array()) {
        add(*links, "links are written as [[links]]");
      } else {
        for (const auto& node : *links->as_array()) read_link(node);
      }
    }
    // toml++ sorts its keys; people expect their modules in the order in which they wrote them.
    std::sort(graph_.modules.begin(), graph_.modules.end(),
              [](const auto& a, const auto& b) { return a.line < b.line; });
    return std::move(graph_);
  }

 private:
  static int line_of(const toml::node& node) {
    return std::max(static_cast<int>(node.source().begin.line), 1);
  }

  void add(const toml::node& node, std::string what) const {
    problems_.add(line_of(node), std::move(what));
  }

  void check_keys(const toml::table& table, const std::vector<std::string>& known,
                  const std::string& where) const {
    for (const auto& [key, node] : table)
      if (std::find(known.begin(), known.end(), key.str()) == known.end())
        add(node, "no key \"" + original(key.str()) + "\" " + where + suggestion(key.str(), known));
  }

  std::optional<std::string> read_string(const toml::table& table, std::string_view key) const {
    const toml::node* node = table.get(key);
    if (node != nullptr && node->is_string())
      return original(node->value<std::string>().value_or(""));
    if (node == nullptr)
      add(table, "\"" + std::string(key) + "\" is missing");
    else
      add(*node, "\"" + std::string(key) + "\" is a string");
    return std::nullopt;
  }

  void read_module(std::string_view name, const toml::node& node) {
    GraphModule& module = graph_.modules.emplace_back();
    module.name = name;
    module.program = name;
    module.line = line_of(node);
    if (!is_name(name)) add(node, "a module's name is snake_case, not \"" + module.name + "\"");
    if (!node.is_table()) return add(node, "a module is a table [modules." + module.name + "]");
    const toml::table& table = *node.as_table();
    check_keys(table, {"program", "parameters", "addresses", "encodings"},
               "in module " + module.name);
    if (table.contains("program"))
      module.program = read_string(table, "program").value_or(module.program);
    read_values(table, "parameters", [&](const std::string& key, const toml::node& value) {
      if (auto text = parameter_text(value)) module.parameters[key] = {*text, line_of(value)};
    });
    read_values(table, "addresses", [&](const std::string& key, const toml::node& value) {
      auto address = value.value_exact<std::int64_t>().value_or(-1);
      if (address < 0 || address > 2147483647)
        return add(value, "an address is a whole number from 0 to 2147483647");
      module.addresses[key] = {address, line_of(value)};
    });
    read_values(table, "encodings", [&](const std::string& key, const toml::node& value) {
      auto encoding = encoding_of(value.value<std::string>().value_or(""));
      if (!encoding) return add(value, R"(an encoding is "text", "binary", "zstd" or "jpeg")");
      module.encodings[key] = {*encoding, line_of(value)};
    });
  }

  template <typename Take>
  void read_values(const toml::table& table, std::string_view key, Take take) {
    const toml::node* node = table.get(key);
    if (node == nullptr) return;
    if (!node->is_table()) return add(*node, "\"" + std::string(key) + "\" is a table");
    for (const auto& [name, value] : *node->as_table()) take(original(name.str()), value);
  }

  std::optional<std::string> parameter_text(const toml::node& node) const {
    if (auto string = node.value_exact<std::string>()) return expand(node, original(*string));
    if (auto flag = node.value_exact<bool>()) return std::string(*flag ? "true" : "false");
    if (node.is_integer() || node.is_floating_point()) {
      std::ostringstream text;
      if (auto number = node.value_exact<double>())
        (text.precision(17), text << *number);
      else
        text << node.value<std::int64_t>().value_or(0);
      return text.str();
    }
    add(node, "a parameter is a string, a number, true or false");
    return std::nullopt;
  }

  /// Puts variables of the environment in.
  std::optional<std::string> expand(const toml::node& node, std::string_view text) const {
    std::string result;
    while (true) {
      auto begin = text.find("${");
      result += text.substr(0, begin);
      if (begin == std::string_view::npos) return result;
      auto end = text.find('}', begin);
      if (end == std::string_view::npos) {
        add(node, "no } after ${");
        return std::nullopt;
      }
      std::string variable{text.substr(begin + 2, end - begin - 2)};
      text.remove_prefix(end + 1);
      std::optional<std::string> otherwise;
      if (auto split = variable.find(":-"); split != std::string::npos) {
        otherwise = variable.substr(split + 2);
        variable.resize(split);
      }
      const char* value = environment_(variable.c_str());
      if (value == nullptr && !otherwise)
        add(node, "the environment has no variable " + variable + "; ${" + variable +
                      ":-VALUE} gives a default");
      result += value != nullptr && *value != '\0' ? value : otherwise.value_or("");
    }
  }

  std::optional<GraphPort> read_port(const toml::table& table, std::string_view key) const {
    auto text = read_string(table, key);
    if (!text) return std::nullopt;
    auto dot = text->find('.');
    if (dot != std::string::npos && is_name(text->substr(0, dot)) && is_name(text->substr(dot + 1)))
      return GraphPort{text->substr(0, dot), text->substr(dot + 1)};
    add(*table.get(key), "\"" + *text + "\" is not MODULE.PORT");
    return std::nullopt;
  }

  void read_link(const toml::node& node) {
    if (!node.is_table()) return add(node, "a link is written as [[links]]");
    const toml::table& table = *node.as_table();
    const std::vector<std::string> policies = {"keep",      "rate",       "burst",
                                               "byte_rate", "byte_burst", "memory"};
    std::vector<std::string> keys = {"from", "to"};
    keys.insert(keys.end(), policies.begin(), policies.end());
    check_keys(table, keys, "in a link");
    auto from = read_port(table, "from"), to = read_port(table, "to");
    GraphLink link{from.value_or(GraphPort()), to.value_or(GraphPort()), {}, line_of(node)};
    Uri policy;  // of the keys so far: each burst stands behind its rate in the list above
    for (const auto& key : policies) {
      const toml::node* value = table.get(key);
      if (value == nullptr) continue;
      auto text = value->value_exact<std::string>();
      if (auto number = value->value_exact<std::int64_t>()) text = std::to_string(*number);
      if (!text) {
        add(*value, key + " is a whole number or a string");
        continue;
      }
      policy.options.emplace_back(key, *text);
      if (auto valid = internal::parse_policy(policy); !valid) {
        add(*value, valid.error().detail);
        policy.options.pop_back();
      }
      link.policy[key] = {*text, line_of(*value)};
    }
    if (from && to) graph_.links.push_back(std::move(link));
  }

  const Environment& environment_;
  Problems& problems_;
  Graph graph_;
};

}  // namespace

GraphModule* Graph::find(std::string_view name) {
  auto found = std::find_if(modules.begin(), modules.end(),
                            [&](const GraphModule& module) { return module.name == name; });
  return found == modules.end() ? nullptr : &*found;
}

Graph parse_graph(std::string_view text, const Environment& environment, Problems& problems) {
  constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  auto refuse_at = [&](std::size_t at, const std::string& what) {
    auto lines = std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n');
    problems.add(static_cast<int>(lines) + 1, what);
    return Graph{problems.file(), {}, {}};
  };
  if (text.size() > kMaxGraphBytes) return refuse_at(0, "a graph file has at most 1048576 bytes");
  if (auto escape = find_escaped_tilde(text); escape != std::string_view::npos)
    return refuse_at(escape, "write ~ itself, not its \\u escape");
  if (auto deep = find_too_deep(text); deep != std::string_view::npos)
    return refuse_at(deep, "a key has at most " + std::to_string(kMaxGraphDepth) +
                               " dots, and as many brackets may stand in one another");
  try {
    toml::table root = toml::parse(ascii_only(text), problems.file());
    return Reader(environment, problems).read(root);
  } catch (const toml::parse_error& error) {
    problems.add(static_cast<int>(error.source().begin.line), original(error.description()));
    return {problems.file(), {}, {}};
  }
}

void set_parameter(Graph& graph, std::string_view assignment, Problems& problems) {
  auto dot = assignment.find('.'), equals = assignment.find('=');
  if (dot == std::string_view::npos || equals == std::string_view::npos || dot > equals)
    return problems.add(0, "\"" + std::string(assignment) + "\" is not MODULE.PARAMETER=VALUE");
  std::string name{assignment.substr(0, dot)};
  GraphModule* module = graph.find(name);
  if (module == nullptr) {
    std::vector<std::string> known;
    for (const auto& each : graph.modules) known.push_back(each.name);
    return problems.add(0, "no module \"" + name + "\" in " + graph.file + suggestion(name, known));
  }
  module->parameters[std::string(assignment.substr(dot + 1, equals - dot - 1))] = {
      std::string(assignment.substr(equals + 1)), 0};
}

}  // namespace hc
