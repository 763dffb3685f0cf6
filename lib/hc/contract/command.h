// SPDX-License-Identifier: Apache-2.0
#pragma once
// What `hc run` says to a module over its --control link: rows of text, written and read here alone
// (spec/module.md). Pure.

#include <string>
#include <string_view>

#include <hc/base/result.h>

namespace hc {

/// One row.
struct ModuleCommand {
  enum class Verb { Set, Link, Unlink, Finish, Route, WallOffset };

  Verb verb = Verb::Set;
  bool is_input = true;  ///< of link and unlink: an input's
  /// Of set the parameter's name; of wall_offset a number; else PORT=URI, as the link was given.
  std::string target;
  std::string value;  ///< of set the value; of route its words, see --route
};

/// "set NAME=VALUE", "link in PORT=URI", "route PORT=URI WORDS" …
std::string text(const ModuleCommand& command);

/// Errors: Invalid; the detail says what commands there are.
Result<ModuleCommand> parse_module_command(std::string_view row);

}  // namespace hc
