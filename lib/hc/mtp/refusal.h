// SPDX-License-Identifier: Apache-2.0
#pragma once
// The text of protocol errors: rule, field, cause, position. Internal. Pure.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include <hc/base/result.h>
#include <hc/base/text.h>

namespace hc::internal {

/// "R7 src: -1 is below 0, at byte 2"; `byte` is optional.
inline Error refusal(Code code, int rule, std::string_view field, std::string_view what,
                     std::optional<std::uint64_t> byte) {
  std::string detail = "R" + std::to_string(rule) + " ";
  detail.append(field).append(": ").append(what);
  if (byte) detail += ", at byte " + std::to_string(*byte);
  return {code, std::move(detail)};
}

/// Received bytes for an error message: quoted, at most 24 of them, escaped unless printable.
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
