// SPDX-License-Identifier: Apache-2.0
#pragma once
// How a module opens its links, and what they are called in its log. Internal.

#include <deque>
#include <memory>
#include <string>

#include <hc/module/module.h>

namespace hc {

/// Opens links. In a graph they are called by their ports, and their log lines are delayed, since
/// at the end of a graph, when all its modules stop, such lines mean nothing.
class Module::LinkOpener {
 public:
  /// @param options  of all links.
  LinkOpener(const Module& module, const LinkOptions& options)
      : module_(module), options_(options) {}

  /// Opens an inlet's source; ends the module if that fails.
  std::unique_ptr<Source> open(const Uri& uri, const std::string& port);
  /// Options for a link, with its log.
  LinkOptions options_for(const Uri& uri, const std::string& port);

  /// Whether `hc run` runs the module.
  [[nodiscard]] bool is_in_graph() const;
  /// What the log calls a link: its port if `hc run` has made it, else its URI.
  [[nodiscard]] std::string name_of(const std::string& uri, const std::string& port) const;

  /// Logs the delayed lines that are due.
  void log_lines(MonotonicTime now);
  /// When the next line is due; the latest time if there is none.
  [[nodiscard]] MonotonicTime due() const {
    return lines_.empty() ? MonotonicTime::max() : lines_.front().due;
  }
  /// Drops the delayed lines about links whose URIs begin like this.
  void drop_lines(const std::string& uri) {
    std::erase_if(lines_, [&](const auto& line) { return line.uri.starts_with(uri); });
  }

 private:
  struct Line {
    std::string uri, text;
    Level level;
    MonotonicTime due;
  };

  const Module& module_;
  LinkOptions options_;
  std::deque<Line> lines_;
};

}  // namespace hc
