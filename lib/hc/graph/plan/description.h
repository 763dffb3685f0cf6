// SPDX-License-Identifier: Apache-2.0
#pragma once
// What a program says of itself with --describe (doc/modules.md), as far as graphs need it. Pure.
// Internal to graph.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <hc/base/parameter.h>
#include <hc/mtp/element.h>

namespace hc::internal {

/// One type of messages that a port gives or takes; 0: any width, height, coordinate system.
struct DescribedType {
  std::string type, scalar;
  std::int64_t components = 0, width = 0, height = 0, coord = 0;
};

struct DescribedPort {
  std::string name;
  std::vector<DescribedType> types;  ///< empty: anything
  bool actor = false;                ///< an input that moves something
};

struct DescribedParameter {
  ParameterState state;  ///< to try values on
  bool fixed = false;    ///< cannot be set while the module runs
};

struct Description {
  std::vector<DescribedPort> inputs, outputs;
  std::vector<DescribedParameter> parameters;
  std::optional<std::vector<std::string>> transports;  ///< nothing: streams
  bool control = false;  ///< knows --control, and the options of modes and addresses
  bool routes = false;   ///< passes messages on by their address

  [[nodiscard]] bool knows(std::string_view transport) const;
};

/// Takes what `program --describe` prints apart; nothing where it is no description of a module.
std::optional<Description> parse_description(std::string_view text);

/// What has that name in a list; null: nothing.
template <typename Described>
const Described* find_named(const std::vector<Described>& list, std::string_view name) {
  for (const auto& each : list)
    if (each.name == name) return &each;
  return nullptr;
}
inline const DescribedParameter* find_named(const std::vector<DescribedParameter>& list,
                                            std::string_view name) {
  for (const auto& each : list)
    if (each.state.name == name) return &each;
  return nullptr;
}

/// The input of every module that knows --control: the number of the mode in focus.
const DescribedPort& focus_input();

/// An input or output; the implicit `focus` among the inputs. Null where there is none.
const DescribedPort* find_input(const Description& description, std::string_view port);
const DescribedPort* find_output(const Description& description, std::string_view port);

std::vector<std::string> names_of(const std::vector<DescribedPort>& ports);
std::vector<std::string> names_of(const std::vector<DescribedParameter>& parameters);

/// Whether what one port gives is what another takes.
bool fits(const DescribedPort& output, const DescribedPort& input);

/// "table 1 x f64 or map 1 x f32 in coordinate system 7"
std::string in_words(const std::vector<DescribedType>& types);

/// A type's elements, were they encoded so. A type that is not known here is of no matrix type.
Info info_from(const DescribedType& type, Encoding encoding);

}  // namespace hc::internal
