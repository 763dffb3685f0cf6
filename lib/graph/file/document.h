// SPDX-License-Identifier: Apache-2.0
#pragma once
// Parses TOML into a tree of values with their places. Safe for any input: text that the TOML
// library cannot handle is refused before. Pure. Internal to graph.

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
  struct List {};   ///< see `nodes`
  struct Table {};  ///< see `nodes`, in the order of the text
  struct Wrong {};  ///< its problem has been reported

  /// monostate: a date or time, which graphs do not use.
  std::variant<std::monostate, std::string, std::int64_t, double, bool, List, Table, Wrong> value;
  std::vector<Node> nodes;
  std::string key;  ///< in its table
  Place place;

  /// The value, if it has this type; otherwise null.
  template <typename T>
  [[nodiscard]] const T* as() const {
    return std::get_if<T>(&value);
  }
  [[nodiscard]] const std::vector<Node>* list() const { return as<List>() ? &nodes : nullptr; }
  [[nodiscard]] const std::vector<Node>* table() const { return as<Table>() ? &nodes : nullptr; }

  /// The value of a key; null if this is not a table or lacks the key.
  [[nodiscard]] const Node* find(std::string_view name) const;
};

/// Parses a text and replaces environment variables in its strings.
///
/// @param file  its index in `problems`.
/// @returns  the root table; nullopt if it is not TOML, too long or too deeply nested.
std::optional<Node> read_document(std::string_view text, int file, const Environment& environment,
                                  Problems& problems);

}  // namespace hc::internal
