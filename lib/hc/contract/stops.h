// SPDX-License-Identifier: Apache-2.0
#pragma once
// The sources that stop or guard the robot, as the module that decides on the focus reports them
// and receives them after a restart, in a parameter `stops` (G27). Pure.

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <hc/base/result.h>

namespace hc {

/// By src: true, the source has stopped the robot; false, it guards it, as the page's server does:
/// the robot halts if it is silent (doc/routing.md).
using Stops = std::map<std::int32_t, bool>;

/// The parameter that `hc run` sets.
inline constexpr const char* kStops = "stops";

bool any_stops(const Stops& stops);

/// A source's name, or "source 14". Programs outside the graph, such as `hc estop`, share src 0.
/// @param names  by src.
std::string source_name(std::int32_t source, const std::map<std::int32_t, std::string>& names);
/// The names of the sources that have stopped the robot.
std::vector<std::string> names_of_stops(const Stops& stops,
                                        const std::map<std::int32_t, std::string>& names);

/// "12=1,14=0": 1 for a source that stops, 0 for one that guards.
std::string stops_text(const Stops& stops);

/// Errors: Invalid (a word that is not SRC=0 or SRC=1).
Result<Stops> parse_stops(std::string_view text);

}  // namespace hc
