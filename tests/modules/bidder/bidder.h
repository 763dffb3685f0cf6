// SPDX-License-Identifier: Apache-2.0
#pragma once
// A script of saliences over time, for demonstrations and tests. Pure.

#include <optional>
#include <string_view>
#include <vector>

#include <hc/base/result.h>

/// From each of its moments on another salience:
///
///     0:0.2 1.5:0.9 3:0           SECONDS:SALIENCE, before the first one 0
///     0:0.2 1.5:0.9 3:end         ends behind 3 s
///     0:0.2 1.5:0.9 3:again       starts over each 3 s
class Script {
 public:
  /// Errors: Invalid (another form; seconds that do not grow; something behind `end` or `again`).
  static hc::Result<Script> parse(std::string_view text);

  /// The salience so many seconds after the beginning; nothing: the script has ended.
  [[nodiscard]] std::optional<double> at(double seconds) const;

 private:
  struct Step {
    double seconds = 0;
    double salience = 0;
  };

  std::vector<Step> steps_;
  std::optional<double> end_;  // [s]
  bool again_ = false;
};
