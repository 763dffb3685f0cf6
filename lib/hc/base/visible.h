// SPDX-License-Identifier: Apache-2.0
#pragma once
// Makes foreign text safe to print on a terminal. Pure.

#include <string>
#include <string_view>

namespace hc {

/// A line with control characters (except tabs), marks of writing direction, and bytes that are not
/// UTF-8 written as `\xNN` per byte: `\x1b` for an escape. Idempotent.
std::string visible(std::string_view line);

}  // namespace hc
