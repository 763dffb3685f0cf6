// SPDX-License-Identifier: Apache-2.0
#pragma once
// What a program says of itself with --describe: one struct, written and read here alone
// (spec/module.md). Pure.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <hc/base/parameter.h>
#include <hc/contract/port_type.h>

namespace hc {

struct PortDescription {
  std::string name, doc;
  std::vector<PortType> types;  ///< an output has one; empty: anything
  bool actor = false;           ///< an input that moves something: one writer at a time
  /// Of an input: how many of the newest messages its links keep unless they say otherwise; 0: it
  /// does not matter to it.
  std::uint32_t keep = 0;
};

struct Description {
  std::string name, summary;
  std::vector<PortDescription> inputs, outputs;
  std::vector<std::vector<std::string>> together;      ///< inputs whose messages are taken together
  std::vector<ParameterState> parameters;              ///< at their defaults
  std::optional<std::vector<std::string>> transports;  ///< nothing: streams
  bool control = false;  ///< knows --control, and the options of modes and addresses
  bool routes = false;   ///< each link gets what its address leads to (--route)

  /// Whether --in and --out take URIs of this scheme.
  [[nodiscard]] bool knows(std::string_view transport) const;
};

/// One line of JSON.
std::string to_json(const Description& description);

/// Takes what `program --describe` prints apart; nothing where it is no description of a module.
/// Whatever the text, memory is in proportion to it.
std::optional<Description> parse_description(std::string_view text);

/// Whether a text is snake_case: a small letter, then small letters, digits and _, 64 at most.
bool is_name(std::string_view text);
/// Whether a text is MODULE.PORT.
bool is_port_name(std::string_view text);

/// Whether the names of all ports are. Errors: Invalid.
Status check_names(const Description& description);

/// The port or parameter of that name; null where there is none.
template <typename Named>
const Named* find_named(const std::vector<Named>& list, std::string_view name) {
  for (const auto& each : list)
    if (each.name == name) return &each;
  return nullptr;
}

template <typename Named>
std::vector<std::string> names_of(const std::vector<Named>& list) {
  std::vector<std::string> names;
  names.reserve(list.size());
  for (const auto& each : list) names.push_back(each.name);
  return names;
}

/// The input of every module that knows --control, which it does not list: the mode in focus.
const PortDescription& focus_input();

/// The output of every module that knows --control, which it does not list: its trace.
const PortDescription& trace_output();

/// An output; the implicit `trace` too. Null where there is none.
const PortDescription* find_output(const Description& description, std::string_view port);

/// An input; the implicit `focus` too. Null where there is none.
const PortDescription* find_input(const Description& description, std::string_view port);

}  // namespace hc
