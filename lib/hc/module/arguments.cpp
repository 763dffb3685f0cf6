// SPDX-License-Identifier: Apache-2.0
#include <hc/module/arguments.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <string_view>
#include <tuple>

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
  return {Code::Invalid, std::move(detail)};
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
    constexpr std::array<std::string_view, 15> kCommon = {
        "--in",     "--out",     "--name",  "--address",   "--encoding",
        "--manage", "--control", "--limit", "--route",     "--to",
        "--mode",   "--modes",   "--clock", "--idle-rate", "--exclusive"};
    return std::find(kCommon.begin(), kCommon.end(), key) != kCommon.end();
  }

  Status unknown(const std::string& key) const {
    return usage("no option \"" + key + "\"; parameters are: " + names(module_.parameters()) +
                 "; see --help");
  }

  Status read_common(const std::string& key, const std::string& value) {
    if (key == "--in" || key == "--out") return read_link(key == "--in", value);
    if (key == "--address" || key == "--to") return read_address(key, value);
    if (key == "--encoding") return read_encoding(value);
    if (key == "--mode" || key == "--modes" || key == "--idle-rate") return read_mode(key, value);
    if (key == "--exclusive") return read_exclusive(value);
    if (key == "--clock") return read_clock(value);
    if (key == "--route") {
      auto route = parse_link_route(value);
      if (!route) return route.error();
      arguments_.routes.push_back(std::move(*route));
      return {};
    }
    if (key == "--name") {
      arguments_.instance = value;
      return {};
    }
    if (key == "--manage" || key == "--control") {
      auto uri = parse_uri(value);
      if (!uri) return uri.error();
      (key == "--manage" ? arguments_.manage : arguments_.control) = *uri;
      return {};
    }
    if (key == "--limit")
      return read_number(value, arguments_.limits.element_bytes, "--limit wants a number of bytes");
    return unknown(key);
  }

  Status read_link(bool is_input, const std::string& value) {
    auto link = parse_port_link(module_, is_input, value);
    if (!link) return link.error();
    if (link->is_focus)
      arguments_.focus.push_back(link->uri);
    else
      (is_input ? arguments_.inputs : arguments_.outputs).emplace_back(link->port, link->uri);
    return {};
  }

  Status read_address(const std::string& key, const std::string& value) {
    auto split = split_port(module_.outputs(), "output", value);
    if (!split) return split.error();
    const bool is_src = key == "--address";
    auto& output = *module_.outputs()[split->first];
    auto& address = is_src ? output.address : output.to;
    std::string wrong = key + " wants [PORT=]NUMBER" + (is_src ? ", 0 to 2147483647" : "") +
                        ", not \"" + value + "\"";
    if (auto read = read_number(split->second, address, wrong); !read) return read;
    return is_src && address < 0 ? usage(wrong) : Status();
  }

  Status read_encoding(const std::string& value) {
    bool all = value.find('=') == std::string::npos;
    auto split = split_port(module_.outputs(), "output", value);
    if (!split) return split.error();
    auto encoding = encoding_of(split->second);
    if (!encoding)
      return usage("--encoding is text, binary, zstd or jpeg, not \"" + split->second + "\"");
    for (std::size_t i = 0; i < module_.outputs().size(); ++i)
      if (all || i == split->first) module_.outputs()[i]->encoding = *encoding;
    return {};
  }

  Status read_mode(const std::string& key, const std::string& value) {
    auto& attention = arguments_.attention;
    if (key == "--idle-rate") {
      auto read = read_number(value, attention.idle_rate, "--idle-rate wants a number [Hz]");
      if (!read) return read;
      return attention.idle_rate >= 0 ? Status() : usage("--idle-rate is not below 0");
    }
    std::string wrong = key + " wants numbers from 1 on, not \"" + value + "\"";
    for (std::string_view rest = value; !rest.empty();) {
      auto word = std::string(rest.substr(0, rest.find(',')));
      rest.remove_prefix(std::min(rest.size(), word.size() + 1));
      std::int32_t number = 0;
      if (auto read = read_number(word, number, wrong); !read || number < 1) return usage(wrong);
      if (key == "--mode")
        attention.own = number;
      else
        attention.modes.push_back(number);
    }
    return {};
  }

  Status read_exclusive(const std::string& value) {
    auto input = find_named(module_.inputs(), value);
    if (input == module_.inputs().end())
      return usage("no input \"" + value + "\"; there are: " + names(module_.inputs()));
    (*input)->is_exclusive = true;
    return {};
  }

  Status read_clock(const std::string& value) {
    if (value != "machine" && value != "messages")
      return usage("--clock is machine or messages, not \"" + value + "\"");
    arguments_.by_messages = value == "messages";
    if (arguments_.by_messages && module_.inputs().empty())
      return usage("--clock messages wants inputs, and this module has none");
    return {};
  }

  template <typename Number>
  static Status read_number(const std::string& text, Number& number, const std::string& wrong) {
    const char* end = text.data() + text.size();
    auto [stop, status] = std::from_chars(text.data(), end, number);
    return status == std::errc() && stop == end ? Status() : usage(wrong);
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

Result<PortLink> parse_port_link(const Module& module, bool is_input, const std::string& text) {
  constexpr std::string_view kFocus = "focus=";
  const bool has_own = find_named(module.inputs(), "focus") != module.inputs().end();
  PortLink link;
  link.is_focus = is_input && !has_own && text.starts_with(kFocus);
  std::string uri = text;
  if (link.is_focus) {
    uri.erase(0, kFocus.size());
  } else {
    auto split = is_input ? split_port(module.inputs(), "input", text)
                          : split_port(module.outputs(), "output", text);
    if (!split) return split.error();
    std::tie(link.port, uri) = *split;
  }
  auto parsed = parse_uri(uri);
  if (!parsed) return parsed.error();
  link.uri = std::move(*parsed);
  return link;
}

Result<std::pair<std::string, Route>> parse_link_route(std::string_view text) {
  auto link = text.substr(0, text.find(' '));
  auto route = parse_route(text.substr(std::min(text.size(), link.size() + 1)));
  if (!route) return route.error();
  return std::pair(std::string(link), std::move(*route));
}

Result<Arguments> parse_arguments(const Module& module, const std::vector<std::string>& words) {
  return Parser(module, words).parse();
}

}  // namespace hc::internal
