// SPDX-License-Identifier: Apache-2.0
#pragma once
// Reads tables of a document: each key has a function that takes its value. Internal to graph.

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <graph/file/document.h>

namespace hc::internal {

/// `"NAME"`
std::string quoted_name(std::string_view name);

/// Parses MODULE.PORT, or a URI if allowed. Errors: Invalid.
Result<GraphPort> parse_port(const std::string& text, bool may_be_uri);

class Fields {
 public:
  using Take = std::function<void(const Node& value)>;
  struct Key {
    std::string name;
    Take take;
    bool is_required = false;
  };

  explicit Fields(Problems& problems) : problems_(problems) {}

  /// Adds a problem, as Problems::add().
  template <typename... Values>
  void add(const Node& node, std::string what, const Values&... values) const {
    problems_.add(node.place, std::move(what), values...);
  }

  /// Passes the values of a table to its keys. Problems: not a table, an unknown key, or a missing
  /// required key.
  ///
  /// @param where  for messages, such as "in module camera".
  void read(const Node& table, const std::string& where, const std::vector<Key>& keys) const;

  /// Problems: a name that is not snake_case. @param what  such as "module".
  bool check_name(const Node& node, const std::string& what, std::string_view name) const;

  // Functions that take a value of one type and report any other as a problem.
  [[nodiscard]] Take text(Lined<std::string>& to) const;
  [[nodiscard]] Take text(std::optional<Lined<std::string>>& to) const;
  /// Like text(), but may be empty.
  [[nodiscard]] Take any_text(Lined<std::string>& to) const;
  [[nodiscard]] Take texts(std::vector<Lined<std::string>>& to) const;
  [[nodiscard]] Take integer(Lined<std::int64_t>& to, std::int64_t min, std::int64_t max) const;
  [[nodiscard]] Take flag(bool& to) const;
  [[nodiscard]] Take numbers(std::array<double, 3>& to) const;
  /// One of some words; passes its index.
  [[nodiscard]] Take choice(std::vector<std::string> words,
                            std::function<void(const Node&, std::size_t)> take) const;
  /// A table with arbitrary keys.
  [[nodiscard]] Take each(Take take) const;
  /// A value or a list of values.
  [[nodiscard]] static Take one_or_more(Take take);

  /// A string, number or boolean as text; nullopt for other types.
  static std::optional<std::string> scalar(const Node& node);

 private:
  Problems& problems_;
};

}  // namespace hc::internal
