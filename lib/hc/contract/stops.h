// SPDX-License-Identifier: Apache-2.0
#pragma once
// Who holds back the focus, as the process that decides on it reports it and as its next process
// gets it: in a parameter `stops` of text (G27). Pure.

#include <cstdint>
#include <map>
#include <string>
#include <string_view>

#include <hc/base/result.h>

namespace hc {

/// By the src of each source: whether it has stopped the robot; else it guards it, as the page's
/// server does, and the robot halts while it is silent (doc/routing.md).
using Stops = std::map<std::int32_t, bool>;

/// The name of the parameter that `hc run` sets.
inline constexpr const char* kStops = "stops";

/// Whether any source has stopped the robot.
bool any_stops(const Stops& stops);

/// "12=1,14=0": 1 of a source that stops, 0 of one that guards.
std::string stops_text(const Stops& stops);

/// Errors: Invalid (a word that is not SRC=0 or SRC=1).
Result<Stops> parse_stops(std::string_view text);

}  // namespace hc
