// SPDX-License-Identifier: Apache-2.0
#pragma once
// The text of an error of the protocol: rule, field, what is wrong, where. Internal. Pure.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include <hc/base/result.h>
#include <hc/base/text.h>

namespace hc::internal {

/// "R7 src: -1 is below 0, at byte 2"; without the byte where there is none.
inline Error refusal(Code code, int rule, std::string_view field, std::string_view what,
                     std::optional<std::uint64_t> byte) {
  std::string detail = "R" + std::to_string(rule) + " ";
  detail.append(field).append(": ").append(what);
  if (byte) detail += ", at byte " + std::to_string(*byte);
  return {code, std::move(detail)};
}

/// Received bytes as part of an error line: in quotes, at most 24 of them, escaped where they are
/// not printable.
inline std::string in_quotes(std::string_view bytes) {
  constexpr std::size_t kShown = 24;
  std::string result = "\"";
  for (char c : bytes.substr(0, kShown)) {
    if (c >= 0x20 && c < 0x7f && c != '"' && c != '\\')
      result += c;
    else
      result.append("\\x").append(hexadecimal_byte(c));
  }
  return result + (bytes.size() > kShown ? "…\"" : "\"");
}

}  // namespace hc::internal
