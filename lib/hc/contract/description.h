// SPDX-License-Identifier: Apache-2.0
#pragma once
// The interface of a module, as its --describe prints it; formatted and parsed only here
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
  std::vector<PortType> types;  ///< an output has one; empty: any
  bool actor = false;           ///< an input that moves something: it takes one writer at a time
  /// Of an input: default of `keep` for its links; 0: no preference.
  std::uint32_t keep = 0;
  /// Of an output: names of the numbers in a row, with their units; empty: none.
  std::vector<std::string> columns{};
};

struct Description {
  std::string name, summary;
  std::vector<PortDescription> inputs, outputs;
  std::vector<std::vector<std::string>> together;      ///< groups of synchronised inputs
  std::vector<ParameterState> parameters;              ///< with default values
  std::optional<std::vector<std::string>> transports;  ///< nullopt: all except shm and inproc
  bool control = false;  ///< supports --control, and the options for modes and addresses
  bool routes = false;   ///< sends each message along the links that its address leads to (--route)

  /// Whether --in and --out take URIs of this scheme.
  [[nodiscard]] bool knows(std::string_view transport) const;
};

/// What a port sends or takes: "table of 1 x f64: mode, salience, age [s]".
std::string in_words(const PortDescription& port);

/// One line of JSON.
std::string to_json(const Description& description);

/// Parses the output of `program --describe`; nullopt if it is not a module's description.
/// Uses memory proportional to the text.
std::optional<Description> parse_description(std::string_view text);

/// Whether a text is snake_case: a lower-case letter, then lower-case letters, digits and _, at
/// most 64 in all.
bool is_name(std::string_view text);
/// Whether a text is MODULE.PORT.
bool is_port_name(std::string_view text);

/// Checks that all ports have names in snake_case. Errors: Invalid.
Status check_names(const Description& description);

/// The port or parameter with a name; null if there is none.
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

/// The implicit input of every module with `control`: the mode in focus.
const PortDescription& focus_input();

/// The implicit output of every module with `control`: its trace.
const PortDescription& trace_output();

/// An output, including the implicit `trace`; null if there is none.
const PortDescription* find_output(const Description& description, std::string_view port);

/// An input, including the implicit `focus`; null if there is none.
const PortDescription* find_input(const Description& description, std::string_view port);

}  // namespace hc
