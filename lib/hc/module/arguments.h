// SPDX-License-Identifier: Apache-2.0
#pragma once
// A module's command line. Internal.

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <hc/base/uri.h>
#include <hc/contract/description.h>
#include <hc/module/module.h>

namespace hc::internal {

/// A link of a port.
struct PortLink {
  bool is_focus = false;  ///< of the input `focus`, which every module has
  bool is_trace = false;  ///< of the output `trace`, which every module has
  std::size_t port = 0;
  Uri uri;
};

/// A command line. Its parameters and the settings of ports are stored in the module itself.
struct Arguments {
  enum class Task { Run, Help, Describe };
  Task task = Task::Run;
  std::string instance;                                 ///< --name
  std::vector<PortLink> inputs, outputs;                ///< --in, --out
  std::vector<std::pair<std::string, Route>> routes;    ///< --route: "PORT=URI", and its route
  Focus focus;                                          ///< --mode, --modes
  bool by_messages = false;                             ///< --clock messages, or a trace
  std::optional<Uri> clock;                             ///< --clock URI: of a trace
  std::optional<std::chrono::nanoseconds> wall_offset;  ///< --wall_offset
  bool joins = false;                                   ///< --join
  std::optional<Uri> manage;                            ///< --manage
  std::optional<Uri> control;                           ///< --control
  Limits limits;                                        ///< --limit
};

/// Reads the command line (without the program's name).
///
/// Errors: Invalid, with the mistake and the possible values.
Result<Arguments> parse_arguments(const Module& module, const std::vector<std::string>& words);

/// Reads `[PORT=]URI`, as --in and --out have it. Errors: Invalid.
Result<PortLink> parse_port_link(const Module& module, bool is_input, const std::string& text);

/// Reads `PORT=URI WORDS`, as --route has it: the first word, and the others. Errors: Invalid.
Result<std::pair<std::string, Route>> parse_link_route(std::string_view text);

/// The options of every module with such ports: with their arguments, and their meanings.
std::vector<std::pair<std::string, std::string>> options_of(const Module& module);

/// The answer to --describe.
Description description_of(const Module& module);

/// The text of --help.
std::string help(const Module& module);

}  // namespace hc::internal
