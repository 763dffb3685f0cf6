// SPDX-License-Identifier: Apache-2.0
#pragma once
// Takes the values of a graph file out of a document, and tells what is wrong with each. Internal
// to graph.

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <hc/graph/file/document.h>
#include <hc/graph/graph_file.h>

namespace hc::internal {

/// Whether a text is snake_case: a small letter, then small letters, digits and _, 64 at most.
bool is_name(std::string_view text);

/// `"NAME"`, for what is told.
std::string quoted_name(std::string_view name);

/// What the readers of all tables have in common.
class Fields {
 public:
  Fields(const Environment& environment, Problems& problems)
      : environment_(environment), problems_(problems) {}

  void add(const Node& node, std::string what) const { problems_.add(node.place, std::move(what)); }

  /// Refuses keys that are not among `known`. @param where  such as "in a link".
  void check_keys(const Node& table, const std::vector<std::string>& known,
                  const std::string& where) const;

  /// Whether a table has a key that nearly is that one, which check_keys() has told.
  static bool misspells(const Node& table, std::string_view key);

  /// Calls `take` with each entry of the table of that key, which may be missing.
  void each(const Node& parent, std::string_view key,
            const std::function<void(const std::string& name, const Node& value)>& take) const;

  /// A string; nothing where it is missing, or of another type, which is told.
  std::optional<Lined<std::string>> text(const Node& parent, std::string_view key) const;
  std::optional<Lined<std::string>> text_if_there(const Node& parent, std::string_view key) const;

  /// A list of strings, or one; those of another type are told.
  std::vector<Lined<std::string>> texts(const Node& parent, std::string_view key) const;

  /// So many numbers; nothing where they are missing, or something else, which is told.
  std::optional<std::vector<double>> numbers(const Node& parent, std::string_view key,
                                             std::size_t count) const;

  /// A parameter as text, with variables of the environment put in.
  std::optional<std::string> parameter(const Node& node) const;

  /// Whom messages are for. Errors are told with the key's name.
  std::optional<Addressee> addressee(const Node& node, std::string_view what) const;

  /// MODULE.PORT, or a URI where it may be one.
  std::optional<GraphPort> port(const Node& node, const std::string& text, bool may_be_uri) const;

 private:
  std::optional<std::string> expand(const Node& node, std::string_view text) const;

  const Environment& environment_;
  Problems& problems_;
};

}  // namespace hc::internal
