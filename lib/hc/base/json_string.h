// SPDX-License-Identifier: Apache-2.0
#pragma once
// Strings of JSON (RFC 8259): what --describe and hc cat --json print. Pure.

#include <string>
#include <string_view>

namespace hc {

/// Appends `text` in quotes, escaped. Each byte that is not UTF-8 becomes U+FFFD.
void append_json_string(std::string_view text, std::string& json);

}  // namespace hc
