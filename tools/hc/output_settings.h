// SPDX-License-Identifier: Apache-2.0
#pragma once
// Options that name modules and outputs of a recording, as those of `hc replay`.

#include <map>
#include <set>
#include <string>
#include <vector>

namespace tool {

/// Throws a Failure, with a suggestion, if there is no module or recorded output of this name.
void check_known(const std::string& name, const std::set<std::string>& known);

/// Numbers for outputs, given as "[MODULE[.PORT]=]NUMBER"; the most specific one applies.
class OutputSettings {
 public:
  /// Throws a Failure if a word is none, or its number is negative.
  /// @param option  its name, for errors.
  OutputSettings(const std::string& option, const std::vector<std::string>& words,
                 double default_value);

  /// @param output  MODULE.PORT.
  [[nodiscard]] double of(const std::string& output) const;
  /// Throws a Failure if a name is not known.
  void check(const std::set<std::string>& known) const;

 private:
  double default_;
  std::map<std::string, double> values_;  // by MODULE.PORT, MODULE or ""
};

}  // namespace tool
