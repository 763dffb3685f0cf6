// SPDX-License-Identifier: Apache-2.0
#include <hc/node/arguments.h>

#include <algorithm>
#include <charconv>
#include <string_view>

namespace hc::internal {
namespace {

template <typename List>
auto find_named(const List& list, std::string_view name) {
  return std::find_if(list.begin(), list.end(),
                      [&](const auto& each) { return each->name == name; });
}

template <typename List>
std::string names(const List& list) {
  std::string text;
  for (const auto& each : list) text.append(text.empty() ? "" : ", ").append(each->name);
  return text.empty() ? "none" : text;
}

Error usage(std::string detail) {
  return {Code::Usage, std::move(detail)};
}

/// "left=unix:@eye" or, for the first port, "unix:@eye".
template <typename Ports>
Result<std::pair<std::size_t, std::string>> split_port(const Ports& ports, std::string_view kind,
                                                       std::string_view text) {
  if (ports.empty()) return usage("this module has no " + std::string(kind));
  auto equals = text.find('=');
  if (equals == std::string_view::npos || text.find_first_of(":/.?") < equals)
    return std::pair<std::size_t, std::string>{0, text};
  auto port = find_named(ports, text.substr(0, equals));
  if (port == ports.end())
    return usage("no " + std::string(kind) + " \"" + std::string(text.substr(0, equals)) +
                 "\"; there are: " + names(ports));
  return std::pair<std::size_t, std::string>{static_cast<std::size_t>(port - ports.begin()),
                                             text.substr(equals + 1)};
}

/// Reads the words one after the other.
class Parser {
 public:
  Parser(const Module& module, const std::vector<std::string>& words)
      : module_(module), words_(words) {}

  Result<Arguments> parse() {
    while (at_ < words_.size()) {
      auto read = read_word();
      if (!read) return read.error();
    }
    return std::move(arguments_);
  }

 private:
  Status read_word() {
    std::string_view word = words_[at_++];
    if (!word.starts_with("--") && !word.starts_with("-h")) return read_positional(word);
    auto equals = word.find('=');
    std::string key{word.substr(0, equals)};
    std::optional<std::string> given;
    if (equals != std::string_view::npos) given = word.substr(equals + 1);

    if (key == "--help" || key == "-h") return set_task(Arguments::Task::Help);
    if (key == "--describe") return set_task(Arguments::Task::Describe);

    auto parameter = find_named(module_.parameters(), std::string_view(key).substr(2));
    bool is_parameter = key.size() > 2 && parameter != module_.parameters().end();
    // A flag stands alone, or with a value after an equals sign.
    if (is_parameter && std::holds_alternative<bool>((*parameter)->value))
      return (*parameter)->set(given.value_or("true"));
    if (!given) {
      if (!is_parameter && !is_common(key)) return unknown(key);
      if (at_ == words_.size()) return usage(key + " wants a value");
      given = words_[at_++];
    }
    if (is_parameter) return (*parameter)->set(*given);
    return read_common(key, *given);
  }

  static bool is_common(std::string_view key) {
    return key == "--in" || key == "--out" || key == "--name" || key == "--address" ||
           key == "--encoding" || key == "--manage" || key == "--limit";
  }

  Status unknown(const std::string& key) const {
    return usage("no option \"" + key + "\"; parameters are: " + names(module_.parameters()) +
                 "; see --help");
  }

  Status read_common(const std::string& key, const std::string& value) {
    if (key == "--in" || key == "--out") return read_link(key == "--in", value);
    if (key == "--address" || key == "--encoding") return read_output(key == "--address", value);
    if (key == "--name") {
      arguments_.instance = value;
      return {};
    }
    if (key == "--manage") {
      auto uri = parse_uri(value);
      if (!uri) return uri.error();
      arguments_.manage = *uri;
      return {};
    }
    if (key == "--limit") {
      auto& limit = arguments_.limits.element_bytes;
      const char* end = value.data() + value.size();
      auto [stop, status] = std::from_chars(value.data(), end, limit);
      if (status != std::errc() || stop != end) return usage("--limit wants a number of bytes");
      return {};
    }
    return unknown(key);
  }

  Status read_link(bool is_input, const std::string& value) {
    auto split = is_input ? split_port(module_.inputs(), "input", value)
                          : split_port(module_.outputs(), "output", value);
    if (!split) return split.error();
    auto uri = parse_uri(split->second);
    if (!uri) return uri.error();
    (is_input ? arguments_.inputs : arguments_.outputs).emplace_back(split->first, *uri);
    return {};
  }

  Status read_output(bool is_address, const std::string& value) {
    bool all = !is_address && value.find('=') == std::string::npos;
    auto split = split_port(module_.outputs(), "output", value);
    if (!split) return split.error();
    const auto& [port, text] = *split;
    if (is_address) {
      auto& address = module_.outputs()[port]->address;
      const char* end = text.data() + text.size();
      auto [stop, status] = std::from_chars(text.data(), end, address);
      if (status != std::errc() || stop != end || address < 0)
        return usage("--address wants [PORT=]NUMBER, 0 to 2147483647, not \"" + value + "\"");
      return {};
    }
    auto encoding = encoding_of(text);
    if (!encoding) return usage("--encoding is text, binary, zstd or jpeg, not \"" + text + "\"");
    for (std::size_t i = 0; i < module_.outputs().size(); ++i)
      if (all || i == port) module_.outputs()[i]->encoding = *encoding;
    return {};
  }

  /// Words without a name go to the positional parameters, in the order of declaration.
  Status read_positional(std::string_view word) {
    std::size_t skip = positional_++;
    for (const auto& parameter : module_.parameters())
      if (parameter->options.positional && skip-- == 0) return parameter->set(word);
    return usage("one argument too many: \"" + std::string(word) + "\"; see --help");
  }

  Status set_task(Arguments::Task task) {
    arguments_.task = task;
    return {};
  }

  const Module& module_;
  const std::vector<std::string>& words_;
  std::size_t at_ = 0;
  std::size_t positional_ = 0;  // words without a name so far
  Arguments arguments_;
};

}  // namespace

Result<Arguments> parse_arguments(const Module& module, const std::vector<std::string>& words) {
  return Parser(module, words).parse();
}

}  // namespace hc::internal
