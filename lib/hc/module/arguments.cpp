// SPDX-License-Identifier: Apache-2.0
#include <hc/module/arguments.h>

#include <algorithm>
#include <array>
#include <limits>
#include <string_view>
#include <tuple>

#include <hc/base/place_word.h>
#include <hc/base/suggestion.h>
#include <hc/base/text.h>
#include <hc/contract/trace.h>

namespace hc::internal {
namespace {

template <typename List>
auto position_of(const List& list, std::string_view name) {
  return std::find_if(list.begin(), list.end(),
                      [&](const auto& each) { return each->name == name; });
}

template <typename List>
std::string names(const List& list) {
  std::string text;
  for (const auto& each : list) text.append(text.empty() ? "" : ", ").append(each->name);
  return text.empty() ? "none" : text;
}

Error invalid(std::string detail) {
  return {Code::Invalid, std::move(detail)};
}

/// "left=unix:@eye" or, for the first port, "unix:@eye".
template <typename Ports>
Result<std::pair<std::size_t, std::string>> split_port(const Ports& ports, std::string_view kind,
                                                       std::string_view text) {
  if (ports.empty()) return invalid("this module has no " + std::string(kind));
  auto equals = text.find('=');
  if (equals == std::string_view::npos || text.find_first_of(":/.?") < equals)
    return std::pair<std::size_t, std::string>{0, text};
  auto port = position_of(ports, text.substr(0, equals));
  if (port == ports.end())
    return invalid("no " + std::string(kind) + " \"" + std::string(text.substr(0, equals)) +
                   "\"; there are: " + names(ports));
  return std::pair<std::size_t, std::string>{static_cast<std::size_t>(port - ports.begin()),
                                             text.substr(equals + 1)};
}

/// Reads words from left to right.
class Parser {
 public:
  Parser(const Module& module, const std::vector<std::string>& words)
      : module_(module), words_(words) {}

  Result<Arguments> parse() {
    while (at_ < words_.size()) {
      HC_TRY(read_word());
    }
    return std::move(arguments_);
  }

  Status in(const std::string& value) { return read_link(true, value); }
  Status out(const std::string& value) { return read_link(false, value); }

  Status address(const std::string& value) {
    const auto wrong = "--address needs [PORT=]NUMBER, 0 to 2147483647, not \"" + value + "\"";
    return read_address(value, wrong, 0, &OutputState::address);
  }
  Status to(const std::string& value) {
    const auto wrong = "--to needs [PORT=]NUMBER, not \"" + value + "\"";
    return read_address(value, wrong, std::numeric_limits<std::int32_t>::min(), &OutputState::to);
  }

  Status encoding(const std::string& value) {
    bool all = value.find('=') == std::string::npos;
    auto split = HC_TRY(split_port(ModuleAccess::outputs(module_), "output", value));
    auto encoding = encoding_of(split.second);
    if (!encoding)
      return invalid("--encoding is text, binary, zstd or jpeg, not \"" + split.second + "\"");
    for (std::size_t i = 0; i < ModuleAccess::outputs(module_).size(); ++i)
      if (all || i == split.first) ModuleAccess::outputs(module_)[i]->encoding = *encoding;
    return {};
  }

  Status limit(const std::string& value) {
    return read_number(value, arguments_.limits.element_bytes, "--limit needs a number of bytes");
  }
  Status name(const std::string& value) {
    arguments_.instance = value;
    return {};
  }
  Status mode(const std::string& value) {
    const auto wrong = "--mode needs a number from 1 on, not \"" + value + "\"";
    auto read = read_number(value, arguments_.focus.own, wrong);
    return read && arguments_.focus.own < 1 ? invalid(wrong) : read;
  }
  Status modes(const std::string& value) {
    const auto wrong = "--modes needs numbers from 1 on, not \"" + value + "\"";
    for (std::string_view rest = value; !rest.empty();) {
      auto& number = arguments_.focus.modes.emplace_back();
      if (!hc::read_number(take_until(rest, ','), number) || number < 1) return invalid(wrong);
    }
    return {};
  }
  Status exclusive(const std::string& value) {
    auto input = position_of(ModuleAccess::inputs(module_), value);
    if (input == ModuleAccess::inputs(module_).end())
      return invalid("no input \"" + value +
                     "\"; there are: " + names(ModuleAccess::inputs(module_)));
    (*input)->is_exclusive = true;
    return {};
  }
  Status route(const std::string& value) {
    auto route = HC_TRY(parse_link_route(value));
    arguments_.routes.push_back(std::move(route));
    return {};
  }
  Status clock(const std::string& value) {
    const bool is_trace = value.find(':') != std::string::npos;
    if (value != "machine" && value != "messages" && !is_trace)
      return invalid("--clock is machine, messages or the URI of a trace, not \"" + value + "\"");
    arguments_.by_messages = value != "machine";
    if (arguments_.by_messages && ModuleAccess::inputs(module_).empty())
      return invalid("--clock messages needs inputs, and this module has none");
    return is_trace ? read_uri(value, arguments_.clock) : Status();
  }
  Status wall_offset(const std::string& value) {
    std::int64_t offset = 0;
    HC_TRY(read_number(value, offset,
                       "--wall_offset needs a number of nanoseconds, not \"" + value + "\""));
    arguments_.wall_offset = std::chrono::nanoseconds(offset);
    return {};
  }
  Status join(const std::string&) {
    arguments_.joins = true;
    return {};
  }
  Status manage(const std::string& value) { return read_uri(value, arguments_.manage); }
  Status control(const std::string& value) { return read_uri(value, arguments_.control); }
  Status describe(const std::string&) { return set_task(Arguments::Task::Describe); }
  Status help(const std::string&) { return set_task(Arguments::Task::Help); }

 private:
  Status read_word();
  [[nodiscard]] Error no_option(const std::string& key) const;

  Status read_link(bool is_input, const std::string& value) {
    auto link = HC_TRY(parse_port_link(module_, is_input, value));
    (is_input ? arguments_.inputs : arguments_.outputs).push_back(std::move(link));
    return {};
  }

  Status read_address(const std::string& value, const std::string& wrong, std::int32_t min,
                      std::int32_t OutputState::*address) {
    auto split = HC_TRY(split_port(ModuleAccess::outputs(module_), "output", value));
    auto& output = *ModuleAccess::outputs(module_)[split.first];
    auto read = read_number(split.second, output.*address, wrong);
    return read && output.*address < min ? invalid(wrong) : read;
  }

  static Status read_uri(const std::string& value, std::optional<Uri>& uri) {
    uri = HC_TRY(parse_uri(value));
    return {};
  }

  template <typename Number>
  static Status read_number(const std::string& text, Number& number, const std::string& wrong) {
    return hc::read_number(text, number) ? Status() : invalid(wrong);
  }

  /// Words without a name go to the positional parameters, in the order of declaration.
  Status read_positional(std::string_view word) {
    std::size_t skip = positional_++;
    for (const auto& parameter : ModuleAccess::parameters(module_))
      if (parameter->options.positional && skip-- == 0) return parameter->set(word);
    return invalid("one argument too many: \"" + std::string(word) + "\"; see --help");
  }

  Status set_task(Arguments::Task task) {
    arguments_.task = task;
    return {};
  }

  const Module& module_;
  const std::vector<std::string>& words_;
  std::size_t at_ = 0;
  std::size_t positional_ = 0;  // words without a name, so far
  Arguments arguments_;
};

/// An option of every module; `doc` is for --help and the documents.
struct Option {
  std::string_view name, argument, doc;
  Status (Parser::*read)(const std::string& value);
  enum { Always, Inputs, Outputs } needs = Always;
};

constexpr std::array<Option, 18> kOptions = {{
    {"--in", "[PORT=]URI",
     "link an input, the first unless PORT is given; may be repeated; without any, inputs share "
     "standard input",
     &Parser::in, Option::Inputs},
    {"--out", "[PORT=]URI",
     "link an output, the first unless PORT is given; may be repeated; without any, outputs share "
     "standard output",
     &Parser::out, Option::Outputs},
    {"--address", "[PORT=]NUMBER",
     "src of an output's messages (default: 1 for the first output, 2 for the second, …)",
     &Parser::address, Option::Outputs},
    {"--to", "[PORT=]NUMBER", "dst of an output's messages that have none", &Parser::to,
     Option::Outputs},
    {"--encoding", "[PORT=]NAME", "text, binary, zstd or jpeg; of all outputs unless PORT is given",
     &Parser::encoding, Option::Outputs},
    {"--limit", "BYTES", "maximum size of a message's payload [bytes] (default 268435456)",
     &Parser::limit},
    {"--name", "NAME", "name used in log lines", &Parser::name},
    {"--mode", "NUMBER",
     "system mode of its messages (default: that of the message handled, else the one in focus)",
     &Parser::mode},
    {"--modes", "NUMBER,…", "modes in which it is active (default: all)", &Parser::modes},
    {"--exclusive", "PORT",
     "an input that takes only messages of the mode in focus; may be repeated", &Parser::exclusive,
     Option::Inputs},
    {"--route", "'PORT=URI WORDS'",
     "which messages a link takes, by their dst (to=21,-5 or to=*), and who is at its other end "
     "(peer=NAME), to whom nothing is sent back; may be repeated",
     &Parser::route},
    {"--clock", "NAME",
     "clock: machine; messages: the times of the messages; or the URI of a trace that it wrote: it "
     "does the same at the same moments (default machine)",
     &Parser::clock, Option::Inputs},
    {"--wall_offset", "NANOSECONDS",
     "times of its messages: so much more than the monotonic clock (default: the wall clock)",
     &Parser::wall_offset},
    {"--join", "",
     "its graph runs: a first message does not wait longer for its readers than those take that do "
     "not hang",
     &Parser::join},
    {"--manage", "URI", "link to send reports to", &Parser::manage},
    {"--control", "URI", "link to take commands from", &Parser::control},
    {"--describe", "", "print ports and parameters as one line of JSON, and end",
     &Parser::describe},
    {"--help", "", "print this, and end (also -h)", &Parser::help},
}};

Error Parser::no_option(const std::string& key) const {
  std::vector<std::string> known;
  for (const auto& each : ModuleAccess::parameters(module_)) known.push_back("--" + each->name);
  for (const auto& each : kOptions) known.emplace_back(each.name);
  const std::string meant = suggestion(key, known);
  return invalid(
      "no option \"" + key + "\"" +
      (meant.empty() ? "; parameters are: " + names(ModuleAccess::parameters(module_)) : meant) +
      "; see --help");
}

Status Parser::read_word() {
  std::string_view word = words_[at_++];
  if (word == "-h") word = "--help";
  if (!word.starts_with("--")) return read_positional(word);
  auto equals = word.find('=');
  const std::string key{word.substr(0, equals)};
  std::optional<std::string> given;
  if (equals != std::string_view::npos) given = word.substr(equals + 1);

  auto parameter = position_of(ModuleAccess::parameters(module_), std::string_view(key).substr(2));
  const bool is_parameter = key.size() > 2 && parameter != ModuleAccess::parameters(module_).end();
  // A flag needs no value, but may have one after an equals sign.
  if (is_parameter && std::holds_alternative<bool>((*parameter)->value))
    return (*parameter)->set(given.value_or("true"));
  auto option = std::find_if(kOptions.begin(), kOptions.end(),
                             [&](const Option& each) { return each.name == key; });
  if (!is_parameter && option == kOptions.end()) return no_option(key);
  if (!is_parameter && option->argument.empty()) return (this->*option->read)("");
  if (!given) {
    if (at_ == words_.size()) return invalid(key + " needs a value");
    given = words_[at_++];
  }
  return is_parameter ? (*parameter)->set(*given) : (this->*option->read)(*given);
}

}  // namespace

std::vector<std::pair<std::string, std::string>> options_of(const Module& module) {
  std::vector<std::pair<std::string, std::string>> options;
  for (const auto& option : kOptions) {
    if (option.needs == Option::Inputs && ModuleAccess::inputs(module).empty()) continue;
    if (option.needs == Option::Outputs && ModuleAccess::outputs(module).empty()) continue;
    std::string left(option.name);
    if (!option.argument.empty()) left.append(" ").append(option.argument);
    options.emplace_back(std::move(left), option.doc);
  }
  return options;
}

Result<PortLink> parse_port_link(const Module& module, bool is_input, const std::string& text) {
  auto is_implied = [&](const auto& own, std::string_view port) {
    return position_of(own, port) == own.end() && text.starts_with(std::string(port) + "=");
  };
  PortLink link;
  link.is_focus = is_input && is_implied(ModuleAccess::inputs(module), "focus");
  link.is_trace = !is_input && is_implied(ModuleAccess::outputs(module), kTracePort);
  std::string uri = text;
  if (link.is_focus || link.is_trace) {
    uri.erase(0, text.find('=') + 1);
  } else {
    auto split = HC_TRY(is_input ? split_port(ModuleAccess::inputs(module), "input", text)
                                 : split_port(ModuleAccess::outputs(module), "output", text));
    std::tie(link.port, uri) = split;
  }
  link.uri = HC_TRY(parse_place_word(uri));
  return link;
}

Result<std::pair<std::string, Route>> parse_link_route(std::string_view text) {
  const auto link = take_until(text, ' ');
  auto route = HC_TRY(parse_route(text));
  return std::pair(std::string(link), std::move(route));
}

Result<Arguments> parse_arguments(const Module& module, const std::vector<std::string>& words) {
  return Parser(module, words).parse();
}

}  // namespace hc::internal
