// SPDX-License-Identifier: Apache-2.0
#pragma once
// Collects all problems of a graph, with file and line.

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <hc/base/format.h>
#include <hc/base/result.h>
#include <hc/base/visible.h>

namespace hc {

/// A position in a graph's files.
struct Place {
  int line = 0;  ///< from 1; 0: not in a file
  int file = 0;  ///< index into Problems::files(); 0: the graph file, others: included files
};

/// The options `--set`.
inline constexpr Place kCommandLine{0, -1};

/// Collects the problems of a graph file and of the files it includes.
class Problems {
 public:
  /// @param file  as given, for error lines.
  explicit Problems(std::string file) : files_{std::move(file)} {}
  /// @param files  as returned by files().
  explicit Problems(std::vector<std::string> files) : files_(std::move(files)) {}

  /// Adds an included file. Returns its index, for places in it.
  int add_file(std::string file) {
    files_.push_back(std::move(file));
    return static_cast<int>(files_.size()) - 1;
  }

  void add(const Place& place, std::string what) { found_.push_back({place, std::move(what)}); }
  /// Adds a problem with values, as format() does.
  template <typename First, typename... Rest>
  void add(const Place& place, std::string_view what, const First& first, const Rest&... rest) {
    add(place, format(what, first, rest...));
  }
  /// Adds a warning.
  void warn(const Place& place, std::string what) { warnings_.push_back({place, std::move(what)}); }

  [[nodiscard]] bool empty() const { return found_.empty(); }
  [[nodiscard]] std::size_t size() const { return found_.size(); }
  [[nodiscard]] const std::vector<std::string>& files() const { return files_; }
  [[nodiscard]] const std::string& file(int number = 0) const {
    return files_.at(static_cast<std::size_t>(number));
  }

  /// Each as "FILE:LINE: WHAT", "--set: WHAT" or "WHAT", sorted by file and line, those without a
  /// file first; control characters are escaped (`\x0a`).
  [[nodiscard]] std::vector<std::string> lines() const { return lines_of(found_); }
  [[nodiscard]] std::vector<std::string> warnings() const { return lines_of(warnings_); }

 private:
  struct Problem {
    Place place;
    std::string what;
  };

  [[nodiscard]] std::vector<std::string> lines_of(std::vector<Problem> sorted) const {
    std::stable_sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) {
      return std::pair(a.place.file, a.place.line) < std::pair(b.place.file, b.place.line);
    });
    std::vector<std::string> lines;
    lines.reserve(sorted.size());
    for (const auto& [place, what] : sorted) lines.push_back(visible(before(place) + what));
    return lines;
  }

  [[nodiscard]] std::string before(const Place& place) const {
    if (place.line == 0) return place.file == kCommandLine.file ? "--set: " : "";
    return file(place.file) + ":" + std::to_string(place.line) + ": ";
  }

  std::vector<std::string> files_;
  std::vector<Problem> found_, warnings_;
};

}  // namespace hc
