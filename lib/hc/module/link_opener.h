// SPDX-License-Identifier: Apache-2.0
#pragma once
// Opens a module's links, and names them in its log. Internal.

#include <deque>
#include <memory>
#include <string>
#include <utility>

#include <hc/module/module.h>

namespace hc {

/// In a graph, links are named by their ports in the log, and their lines are delayed: when a whole
/// graph stops, lines about its links would only confuse.
class Module::LinkOpener {
 public:
  /// @param options  of all links.
  LinkOpener(const Module& module, LinkOptions options)
      : module_(module), options_(std::move(options)) {}

  /// Opens a source; ends the module if that fails.
  std::unique_ptr<Source> open(const Uri& uri, const std::string& port);
  LinkOptions options_for(const Uri& uri, const std::string& port);

  /// Whether the module takes commands, so that it runs in a graph.
  [[nodiscard]] bool is_in_graph() const;
  /// The port of a link that `hc run` has made, else the URI.
  [[nodiscard]] std::string name_of(const std::string& uri, const std::string& port) const;

  void log_lines(MonotonicTime now);
  /// When the next line is due.
  [[nodiscard]] MonotonicTime due() const {
    return lines_.empty() ? MonotonicTime::max() : lines_.front().due;
  }
  /// Drops the delayed lines about links whose URIs begin like this one.
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
