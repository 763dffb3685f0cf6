// SPDX-License-Identifier: Apache-2.0
#include <hc/contract/command.h>

#include <array>

#include <hc/base/text.h>

namespace hc {
namespace {

constexpr std::array<std::string_view, 6> kVerbs = {"set",    "link",  "unlink",
                                                    "finish", "route", "wall_offset"};

bool has_end(ModuleCommand::Verb verb) {
  return verb == ModuleCommand::Verb::Link || verb == ModuleCommand::Verb::Unlink;
}

}  // namespace

std::string text(const ModuleCommand& command) {
  std::string row(kVerbs[static_cast<std::size_t>(command.verb)]);
  if (has_end(command.verb)) row += command.is_input ? " in" : " out";
  row += " " + command.target;
  if (command.verb == ModuleCommand::Verb::Set) row += "=" + command.value;
  if (command.verb == ModuleCommand::Verb::Route) row += " " + command.value;
  return row;
}

Result<ModuleCommand> parse_module_command(std::string_view row) {
  const Error wrong{Code::Invalid,
                    "a command is set NAME=VALUE, link or unlink in|out PORT=URI, finish PORT=URI, "
                    "route PORT=URI WORDS, or wall_offset NANOSECONDS"};
  const auto verb = enum_named<ModuleCommand::Verb>(kVerbs, take_until(row, ' '));
  if (!verb || row.empty()) return wrong;
  ModuleCommand command;
  command.verb = *verb;
  if (has_end(command.verb)) {
    const auto end = take_until(row, ' ');
    if ((end != "in" && end != "out") || row.empty()) return wrong;
    command.is_input = end == "in";
  }
  if (command.verb == ModuleCommand::Verb::Set) {
    if (row.find('=') == std::string_view::npos) return wrong;
    command.target = take_until(row, '=');
    command.value = row;
  } else if (command.verb == ModuleCommand::Verb::Route) {
    command.target = take_until(row, ' ');
    command.value = row;
  } else {
    command.target = row;
  }
  return command;
}

}  // namespace hc
