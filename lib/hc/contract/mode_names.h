// SPDX-License-Identifier: Apache-2.0
#pragma once
// The names of a graph's modes, and of the outputs linked to a module, as `hc run` passes them to
// it in its parameters `mode_names` and `source_names` (G25). Pure.

#include <cstdint>
#include <map>
#include <string>
#include <string_view>

#include <hc/base/result.h>

namespace hc {

/// The parameters that `hc run` sets.
inline constexpr const char* kModeNames = "mode_names";
inline constexpr const char* kSourceNames = "source_names";

/// "read=5,track=4".
std::string mode_names_text(const std::map<std::string, std::int64_t>& numbers);

/// The names by number; none in an empty text.
/// @param parameter  name of the parameter, for errors.
///
/// Errors: Invalid (a word that is not NAME=NUMBER, with a unique number ≥ 1).
Result<std::map<std::int32_t, std::string>> parse_mode_names(
    std::string_view text, std::string_view parameter = kModeNames);

}  // namespace hc
