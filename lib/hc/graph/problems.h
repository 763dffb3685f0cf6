// SPDX-License-Identifier: Apache-2.0
#pragma once
// What is wrong with a graph: all of it, each with its line.

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <hc/base/result.h>

namespace hc {

/// Collects what is wrong with one graph file.
class Problems {
 public:
  /// @param file  as it was given, for the lines.
  explicit Problems(std::string file) : file_(std::move(file)) {}

  /// @param line  of the file, from 1 on; 0: the problem is in what was set beside the file.
  void add(int line, std::string what) { found_.push_back({line, std::move(what)}); }

  [[nodiscard]] bool empty() const { return found_.empty(); }
  [[nodiscard]] std::size_t size() const { return found_.size(); }
  [[nodiscard]] const std::string& file() const { return file_; }

  /// Each as "FILE:LINE: WHAT", or "--set: WHAT", in the order of the lines.
  [[nodiscard]] std::vector<std::string> lines() const {
    auto sorted = found_;
    std::stable_sort(sorted.begin(), sorted.end(),
                     [](const auto& a, const auto& b) { return a.line < b.line; });
    std::vector<std::string> lines;
    lines.reserve(sorted.size());
    for (const auto& [line, what] : sorted)
      lines.push_back(line == 0 ? "--set: " + what
                                : file_ + ":" + std::to_string(line) + ": " + what);
    return lines;
  }

 private:
  struct Problem {
    int line;
    std::string what;
  };

  std::string file_;
  std::vector<Problem> found_;
};

}  // namespace hc
