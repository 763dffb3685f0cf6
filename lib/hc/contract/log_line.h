// SPDX-License-Identifier: Apache-2.0
#pragma once
// A log line with its level, as a module reports it to `hc run` and as a running graph publishes it
// (spec/module.md, spec/graph.md). Pure.

#include <optional>
#include <string>
#include <string_view>

#include <hc/base/log.h>
#include <hc/base/result.h>
#include <hc/mtp/message.h>

namespace hc {

/// "info", "warning" and so on.
std::string_view name(Level level);
std::optional<Level> level_named(std::string_view name);

struct LogLine {
  std::string module;  ///< or "graph" for the graph itself
  Level level = Level::Info;
  std::string text;

  /// "camera: error: no such device"; levels other than error are not shown.
  [[nodiscard]] std::string line() const;
};

/// A module's report: a string with a row "LEVEL TEXT".
Message make_log(Level level, std::string_view text);
/// Errors: Malformed.
Result<LogLine> read_log(const Message& message);

/// As a graph publishes it: one line of JSON.
std::string to_json(const LogLine& line);
/// Errors: Malformed.
Result<LogLine> parse_log_line(std::string_view json);

}  // namespace hc
