// SPDX-License-Identifier: Apache-2.0
#pragma once
// URIs of links: `tcp:localhost:7000`, `file:eyes.mtp`, `unix:/run/eye?reconnect=2`, `-`.
// Pure; the link layer knows the schemes and options.

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <hc/base/result.h>

namespace hc {

/// A parsed URI. Nothing is percent-decoded: a path is the bytes between `:` and `?`.
struct Uri {
  std::string scheme;  ///< [a-z][a-z0-9+-]*; "-" for standard input or output
  std::string rest;    ///< what follows the colon, up to `?`; a path, a name, HOST:PORT
  std::vector<std::pair<std::string, std::string>> options;  ///< after `?`, `key=value&key=value`

  /// The value of an option, or `default_value`.
  [[nodiscard]] std::string_view option(std::string_view key, std::string_view default_value) const;

  /// The URI as text; the inverse of parse_uri().
  [[nodiscard]] std::string text() const;
};

/// Parses a URI. `-` alone is standard input or output. A text without a scheme (no colon, or a `/`
/// or `.` before it) is the path of a file: `eyes.mtp` is `file:eyes.mtp`.
///
/// Errors: Invalid (empty; longer than 4096 bytes; a NUL, line end or other control byte; an
/// invalid scheme; an option without `=`, without a key, or given twice).
Result<Uri> parse_uri(std::string_view text);

/// The values that a numeric option accepts.
struct NumberRange {
  std::int64_t least = 0, most = 1'000'000'000;
  bool has_units = false;  ///< may be followed by K, M or G (of 1024)
};

/// An integer option, or `default_value`. Errors: Invalid.
Result<std::int64_t> number_option(const Uri& uri, std::string_view key, std::int64_t default_value,
                                   const NumberRange& range = {});

/// The address of a TCP link.
struct HostPort {
  std::string host;  ///< name or address, IPv6 without its brackets; empty: none given
  std::uint16_t port = 0;
};

/// Parses `[HOST:]PORT`; IPv6 addresses are in brackets, `[::1]:7000`.
///
/// Errors: Invalid (no port, a port outside 0 … 65535, an unclosed bracket).
Result<HostPort> parse_host_port(std::string_view text);

}  // namespace hc
