// SPDX-License-Identifier: Apache-2.0
#pragma once
// Strings of JSON (RFC 8259): what --describe and hc cat --json print. Pure.

#include <cstddef>
#include <string>
#include <string_view>

namespace hc {

/// Bytes of the well-formed UTF-8 character at the start of `text`; 0 when there is none.
std::size_t utf8_length(std::string_view text);

/// Appends `text` in quotes, escaped. Each byte that is not UTF-8 becomes U+FFFD.
void append_json_string(std::string_view text, std::string& json);

}  // namespace hc
