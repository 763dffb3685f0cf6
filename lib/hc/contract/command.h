// SPDX-License-Identifier: Apache-2.0
#pragma once
// What `hc run` tells a module over its --control link: rows of text, written and read here alone
// (spec/module.md). Pure.

#include <string>
#include <string_view>

#include <hc/base/result.h>

namespace hc {

/// One row.
struct ModuleCommand {
  enum class Verb { Set, Link, Unlink, Finish, Route };

  Verb verb = Verb::Set;
  bool is_input = true;  ///< of link and unlink: an input's
  std::string target;    ///< of set the parameter's name; else PORT=URI, as the link was given
  std::string value;     ///< of set the value; of route its words, see --route
};

/// "set NAME=VALUE", "link in PORT=URI", "route PORT=URI WORDS" …
std::string text(const ModuleCommand& command);

/// Errors: Invalid; the detail says what commands there are.
Result<ModuleCommand> parse_module_command(std::string_view row);

}  // namespace hc
