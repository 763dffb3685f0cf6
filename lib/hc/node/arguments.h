// SPDX-License-Identifier: Apache-2.0
#pragma once
// A module's command line. Internal.

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <hc/base/uri.h>
#include <hc/node/module.h>

namespace hc::internal {

/// What a command line asks for. Parameters, addresses and encodings are set in the module itself.
struct Arguments {
  enum class Task { Run, Help, Describe };
  Task task = Task::Run;
  std::string instance;                              ///< --name
  std::vector<std::pair<std::size_t, Uri>> inputs;   ///< port, link
  std::vector<std::pair<std::size_t, Uri>> outputs;  ///< port, link
  std::optional<Uri> manage;                         ///< --manage
  Limits limits;                                     ///< --limit
};

/// Reads the command line (without the program's name).
///
/// Errors: Usage, with what is wrong and what there would be.
Result<Arguments> parse_arguments(const Module& module, const std::vector<std::string>& words);

/// The text of --help.
std::string help(const Module& module);

/// The text of --describe: a JSON object of ports, parameters and what goes with them; see
/// doc/modules.md.
std::string describe(const Module& module);

}  // namespace hc::internal
