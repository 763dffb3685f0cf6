// SPDX-License-Identifier: Apache-2.0
#include <graph/file/document.h>

#include <algorithm>
#include <charconv>
#include <tuple>

#include <hc/base/json_string.h>
#include <hc/base/text.h>

// toml++ before 3.4 asserts conditions that hostile text violates (a line end in a table's name),
// although it reports the same error next; so its assertions are disabled.
#pragma push_macro("NDEBUG")
#undef NDEBUG
#define TOML_ASSERT(condition) static_cast<void>(0)
#include <toml++/toml.h>
#pragma pop_macro("NDEBUG")

namespace hc::internal {
namespace {

/// toml++ up to 3.4 has undefined behaviour for misplaced non-ASCII characters. This encodes each
/// of their bytes as ~ and two hexadecimal digits; original() decodes them.
std::string ascii_only(std::string_view text) {
  std::string result;
  result.reserve(text.size());
  for (char c : text) {
    if (static_cast<unsigned char>(c) < 0x80 && c != '~')
      result += c;
    else
      result.append("~").append(hexadecimal_byte(c));
  }
  return result;
}

/// Position of the first byte that is not UTF-8; npos: none.
std::size_t find_no_utf8(std::string_view text) {
  for (std::size_t at = 0; at < text.size();) {
    std::size_t length = utf8_length(text.substr(at));
    if (length == 0) return at;
    at += length;
  }
  return std::string_view::npos;
}

/// Position of an escaped ~ (\u007e), which original() would decode by mistake; npos: none.
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

/// The position behind the string that opens at `at`; the end of `text` if it is not closed.
std::size_t skip_string(std::string_view text, std::size_t at) {
  const char quote = text[at];
  const std::string closing(text.substr(at, 3) == std::string(3, quote) ? 3 : 1, quote);
  for (at += closing.size(); at < text.size(); ++at) {
    if (quote == '"' && text[at] == '\\') {
      ++at;
    } else if (text.substr(at).starts_with(closing)) {
      at += closing.size();
      // Up to two quotes may precede the closing three.
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

/// Position where a key has too many parts, or brackets are nested too deeply; npos: none. toml++
/// recurses once per level, so the depth is limited first. Invalid TOML may be misread here, but
/// only beyond the point where toml++ stops.
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

/// Replaces toml++'s messages for the commonest mistakes and for encoded characters.
std::string in_plain_words(std::string_view description, std::string_view toml) {
  auto says = [&](std::string_view words) {
    return description.find(words) != std::string_view::npos;
  };
  const bool has_control = std::any_of(toml.begin(), toml.end(), [](char c) {
    return (c >= 0 && c < ' ' && c != '\t' && c != '\n' && c != '\r') || c == 0x7f;
  });
  if (says("string: encountered end-of-file") ||
      (says("control characters other than TAB") && !has_control))
    return "a quote is missing: this string has no end";
  if (says("could not determine value type")) return "no such value; a string needs quotes";
  if (says("expected comma or closing ']'")) return "a list lacks a comma, a quote or its \"]\"";
  if (says("inline table") && says("saw '\\n'"))
    return "a table in braces is one line, and its \"}\" is missing there";
  constexpr std::string_view kOurs = "saw '~'";
  std::string text(description);
  if (auto at = text.find(kOurs); at != std::string::npos)
    text.replace(at, kOurs.size(), "saw a character that is for strings and comments");
  return text;
}

Node convert(const toml::node& from, int file) {
  Node node;
  node.place = {std::max(static_cast<int>(from.source().begin.line), 1), file};
  if (auto text = from.value_exact<std::string>()) node.value = original(*text);
  if (auto number = from.value_exact<std::int64_t>()) node.value = *number;
  if (auto number = from.value_exact<double>()) node.value = *number;
  if (auto flag = from.value_exact<bool>()) node.value = *flag;
  if (const toml::array* list = from.as_array()) {
    node.value = Node::List();
    for (const auto& each : *list) node.nodes.push_back(convert(each, file));
  }
  if (const toml::table* table = from.as_table()) {
    node.value = Node::Table();
    // toml++ sorts keys; restore the order of the text.
    std::vector<std::tuple<toml::source_index, toml::source_index, Node>> entries;
    for (const auto& [key, each] : *table) {
      const auto& begin = each.source().begin;
      entries.emplace_back(begin.line, begin.column, convert(each, file));
      std::get<Node>(entries.back()).key = original(key.str());
    }
    std::stable_sort(entries.begin(), entries.end(), [](const auto& a, const auto& b) {
      return std::pair(std::get<0>(a), std::get<1>(a)) < std::pair(std::get<0>(b), std::get<1>(b));
    });
    for (auto& entry : entries) node.nodes.push_back(std::move(std::get<Node>(entry)));
  }
  return node;
}

/// The value of `${NAME}` or `${NAME:-DEFAULT}`. @param variable  NAME or NAME:-DEFAULT.
Result<std::string> value_of(std::string variable, const Environment& environment) {
  std::optional<std::string> default_value;
  if (auto split = variable.find(":-"); split != std::string::npos) {
    default_value = variable.substr(split + 2);
    variable.resize(split);
  }
  if (variable.empty()) return Error{Code::Invalid, "${} names no variable"};
  if (default_value && default_value->find("${") != std::string::npos)
    return Error{Code::Invalid, "variables do not nest: the default of ${" + variable +
                                    "} has a \"${\"; name one variable, or write its value"};
  const char* value = environment ? environment(variable.c_str()) : nullptr;
  if (value == nullptr && !default_value)
    return Error{Code::Invalid, "environment variable " + variable + " is not set; ${" + variable +
                                    ":-VALUE} gives a default"};
  return value != nullptr && *value != '\0' ? value : default_value.value_or("");
}

/// Replaces variables in all strings of a value. A string with a problem becomes Node::Wrong.
void expand(Node& node, const Environment& environment, Problems& problems) {
  for (Node& each : node.nodes) expand(each, environment, problems);
  if (node.list() != nullptr)
    std::erase_if(node.nodes, [](const Node& each) { return each.as<Node::Wrong>() != nullptr; });
  if (node.as<std::string>() == nullptr) return;
  const std::string text = *node.as<std::string>();
  std::string expanded;
  std::size_t at = 0;
  bool is_right = true;
  for (auto begin = text.find("${"); begin != std::string::npos; begin = text.find("${", at)) {
    const auto end = text.find('}', begin);
    auto value = end == std::string::npos
                     ? Result<std::string>(Error{Code::Invalid, R"("${" without "}")"})
                     : value_of(text.substr(begin + 2, end - begin - 2), environment);
    if (!value) problems.add(node.place, value.error().detail);
    is_right = is_right && value;
    expanded += text.substr(at, begin - at) + (value ? *value : "");
    at = std::min(end, text.size() - 1) + 1;
  }
  if (is_right)
    node.value = expanded + text.substr(at);
  else
    node.value = Node::Wrong();
}

}  // namespace

const Node* Node::find(std::string_view name) const {
  if (table() == nullptr) return nullptr;
  auto found =
      std::find_if(nodes.begin(), nodes.end(), [&](const Node& node) { return node.key == name; });
  return found == nodes.end() ? nullptr : &*found;
}

std::optional<Node> read_document(std::string_view text, int file, const Environment& environment,
                                  Problems& problems) {
  constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  auto refuse_at = [&](std::size_t at, const std::string& what) {
    auto lines = std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n');
    problems.add({static_cast<int>(lines) + 1, file}, what);
    return std::nullopt;
  };
  if (text.size() > kMaxGraphBytes)
    return refuse_at(0, "a graph file has at most " + std::to_string(kMaxGraphBytes) + " bytes");
  if (auto odd = find_no_utf8(text); odd != std::string_view::npos)
    return refuse_at(odd, "this line is not UTF-8");
  if (auto escape = find_escaped_tilde(text); escape != std::string_view::npos)
    return refuse_at(escape, "write ~ itself, not its \\u escape");
  if (auto deep = find_too_deep(text); deep != std::string_view::npos)
    return refuse_at(deep, "at most " + std::to_string(kMaxGraphDepth) +
                               " dots in a key, and as many nested brackets");
  try {
    auto root = convert(toml::parse(ascii_only(text), problems.file(file)), file);
    expand(root, environment, problems);
    return root;
  } catch (const toml::parse_error& error) {
    problems.add({std::max(static_cast<int>(error.source().begin.line), 1), file},
                 original(in_plain_words(error.description(), text)));
    return std::nullopt;
  }
}

}  // namespace hc::internal
