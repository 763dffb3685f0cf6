// SPDX-License-Identifier: Apache-2.0
#pragma once
// A TOML text as a tree of values, each with its place. Any text is read or refused: what the TOML
// library cannot handle never reaches it. Pure. Internal to graph.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <graph/graph_file.h>

namespace hc::internal {

/// A value of a document.
struct Node {
  struct List {};   ///< its values are in `nodes`
  struct Table {};  ///< the same, each with its key, in the order of the text
  struct Wrong {};  ///< its problem has been added

  /// Dates and times, which no graph has, are monostate.
  std::variant<std::monostate, std::string, std::int64_t, double, bool, List, Table, Wrong> value;
  std::vector<Node> nodes;
  std::string key;  ///< in its table
  Place place;

  /// The value of that type; null where it is of another.
  template <typename T>
  [[nodiscard]] const T* as() const {
    return std::get_if<T>(&value);
  }
  [[nodiscard]] const std::vector<Node>* list() const { return as<List>() ? &nodes : nullptr; }
  [[nodiscard]] const std::vector<Node>* table() const { return as<Table>() ? &nodes : nullptr; }

  /// The value of a key; null where this is no table, or has no such key.
  [[nodiscard]] const Node* find(std::string_view name) const;
};

/// Reads a text, and replaces the variables of the environment in its strings.
///
/// @param file  its number in `problems`.
/// @returns  its table; nothing where it is not TOML, too long or too deep.
std::optional<Node> read_document(std::string_view text, int file, const Environment& environment,
                                  Problems& problems);

}  // namespace hc::internal
