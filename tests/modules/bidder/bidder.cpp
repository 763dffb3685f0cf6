// SPDX-License-Identifier: Apache-2.0
#include "bidder.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <hc/base/text.h>

namespace {

std::optional<double> parse_number(std::string_view text) {
  double number = 0;
  return hc::read_number(text, number) ? std::optional(number) : std::nullopt;
}

}  // namespace

hc::Result<Script> Script::parse(std::string_view text) {
  Script script;
  double latest = -1;
  while (true) {
    text.remove_prefix(std::min(text.find_first_not_of(' '), text.size()));
    if (text.empty()) return script;
    auto word = text.substr(0, text.find(' '));
    text.remove_prefix(word.size());
    auto wrong = [&](const char* what) {
      return hc::Error{hc::Code::Invalid, "\"" + std::string(word) + "\" " + what};
    };
    auto colon = std::min(word.find(':'), word.size());
    auto seconds = parse_number(word.substr(0, colon));
    auto what = word.substr(std::min(colon + 1, word.size()));
    auto salience = parse_number(what);
    bool is_last = what == "end" || what == "again";
    if (!seconds || !(salience || is_last)) return wrong("is not SECONDS:SALIENCE");
    if (script.end_) return wrong("is behind the end");
    if (!(*seconds >= 0 && *seconds > latest && std::isfinite(*seconds)))
      return wrong("is not later than what is before it");
    latest = *seconds;
    if (is_last)
      script.end_ = *seconds;
    else
      script.steps_.push_back({*seconds, *salience});
    script.again_ = what == "again";
    if (script.again_ && *seconds == 0) return wrong("starts over at once");
  }
}

std::optional<double> Script::at(double seconds) const {
  if (again_)
    seconds = std::fmod(seconds, *end_);
  else if (end_ && seconds >= *end_)
    return std::nullopt;
  double salience = 0;
  for (const Step& step : steps_)
    if (step.seconds <= seconds) salience = step.salience;
  return salience;
}
