// SPDX-License-Identifier: Apache-2.0
#pragma once
// The names of a graph's modes, as a module gets them: in a parameter `mode_names` of text (G25);
// and those of the outputs that are linked to it, in `source_names` (G25). Pure.

#include <cstdint>
#include <map>
#include <string>
#include <string_view>

#include <hc/base/result.h>

namespace hc {

/// The names of the parameters that `hc run` sets.
inline constexpr const char* kModeNames = "mode_names";
inline constexpr const char* kSourceNames = "source_names";

/// "read=5,track=4" of the numbers by their names.
std::string mode_names_text(const std::map<std::string, std::int64_t>& numbers);

/// The names by their numbers; an empty text has none.
/// @param parameter  that has the text, for errors.
///
/// Errors: Invalid (a word that is not NAME=NUMBER, with a number from 1 on that no other has).
Result<std::map<std::int32_t, std::string>> parse_mode_names(
    std::string_view text, std::string_view parameter = kModeNames);

}  // namespace hc
