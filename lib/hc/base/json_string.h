// SPDX-License-Identifier: Apache-2.0
#pragma once
// JSON strings (RFC 8259), as --describe and hc cat --json print them. Pure.

#include <cstddef>
#include <string>
#include <string_view>

namespace hc {

/// Length in bytes of the UTF-8 character at the start of `text`; 0 if it is not well-formed.
std::size_t utf8_length(std::string_view text);

/// Appends `text`, quoted and escaped. Each byte that is not UTF-8 becomes U+FFFD.
void append_json_string(std::string_view text, std::string& json);

}  // namespace hc
