// SPDX-License-Identifier: Apache-2.0
#pragma once
// Text of others, made harmless for a terminal. Pure.

#include <string>
#include <string_view>

namespace hc {

/// A line with everything that would steer a terminal, or that is not UTF-8, in a visible form:
/// `\x1b` for an escape. Control characters (but tabs), marks of writing direction, and bytes that
/// are not UTF-8 become \xNN for each byte. Of a visible line it makes the same line.
std::string visible(std::string_view line);

}  // namespace hc
