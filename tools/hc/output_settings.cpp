// SPDX-License-Identifier: Apache-2.0
#include "output_settings.h"

#include <cmath>

#include <hc/base/suggestion.h>
#include <hc/base/text.h>

#include "common.h"

namespace tool {

void check_known(const std::string& name, const std::set<std::string>& known) {
  if (!known.contains(name))
    throw Failure(hc::Code::Invalid, "no module or recorded output \"" + name + "\"" +
                                         hc::suggestion(name, {known.begin(), known.end()}));
}

OutputSettings::OutputSettings(const std::string& option, const std::vector<std::string>& words,
                               double default_value)
    : default_(default_value) {
  for (const auto& word : words) {
    const auto equals = word.find('=');
    const auto number = equals == std::string::npos ? word : word.substr(equals + 1);
    double value = 0;
    if (!hc::read_number(number, value) || !(value >= 0 && std::isfinite(value)))
      throw Failure(hc::Code::Invalid, option + " is [MODULE[.PORT]=]NUMBER, not " + word);
    values_[equals == std::string::npos ? "" : word.substr(0, equals)] = value;
  }
}

double OutputSettings::of(const std::string& output) const {
  for (const auto& name : {output, output.substr(0, output.find('.')), std::string()})
    if (const auto found = values_.find(name); found != values_.end()) return found->second;
  return default_;
}

void OutputSettings::check(const std::set<std::string>& known) const {
  for (const auto& [name, value] : values_)
    if (!name.empty()) check_known(name, known);
}

}  // namespace tool
