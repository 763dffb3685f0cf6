// SPDX-License-Identifier: Apache-2.0
#pragma once
// Commands of `hc run` to a module over its --control link: rows of text, formatted and parsed only
// here (spec/module.md). Pure.

#include <string>
#include <string_view>

#include <hc/base/result.h>

namespace hc {

struct ModuleCommand {
  enum class Verb { Set, Link, Unlink, Finish, Route, WallOffset };

  Verb verb = Verb::Set;
  bool is_input = true;  ///< of link and unlink: the end of an input
  /// The parameter's name (set), a number (wall_offset), else PORT=URI as given for the link.
  std::string target;
  std::string value;  ///< the parameter's value (set), or the words of a --route (route)
};

/// "set NAME=VALUE", "link in PORT=URI", "route PORT=URI WORDS", …
std::string text(const ModuleCommand& command);

/// Errors: Invalid; the detail lists the commands.
Result<ModuleCommand> parse_module_command(std::string_view row);

}  // namespace hc
