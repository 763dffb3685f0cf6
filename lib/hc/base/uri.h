// SPDX-License-Identifier: Apache-2.0
#pragma once
// Names a link's end: `tcp:localhost:7000`, `file:eyes.mtp`, `unix:/run/eye?encoding=zstd`, `-`.
// Pure; the link layer knows which schemes and options there are.

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <hc/base/result.h>

namespace hc {

/// A URI taken apart. Nothing is percent-decoded: a path is the bytes between `:` and `?`.
struct Uri {
  std::string scheme;  ///< [a-z][a-z0-9+-]*; "-" for standard input or output
  std::string rest;    ///< what follows the colon, up to `?`; a path, a name, HOST:PORT
  std::vector<std::pair<std::string, std::string>> options;  ///< after `?`, `key=value&key=value`

  /// The value of an option, or `otherwise` where it is not given.
  [[nodiscard]] std::string_view option(std::string_view key, std::string_view default_value) const;

  /// The URI as text; parse_uri gives it back.
  [[nodiscard]] std::string text() const;
};

/// Takes a URI apart. `-` alone is standard input or output. A text without a scheme (no colon, or
/// a `/` or `.` before it) is a file's path: `eyes.mtp` is `file:eyes.mtp`.
///
/// Errors: Invalid (empty; longer than 4096 bytes; a NUL, line end or other control byte; a scheme
/// with other letters; an option without `=`, without a key, or given twice).
Result<Uri> parse_uri(std::string_view text);

/// What numbers an option takes.
struct NumberRange {
  std::int64_t least = 0, most = 1'000'000'000;
  bool has_units = false;  ///< may be followed by K, M or G (of 1024)
};

/// An option that is a whole number, or `default_value` where it is not given. Errors: Invalid.
Result<std::int64_t> number_option(const Uri& uri, std::string_view key, std::int64_t default_value,
                                   const NumberRange& range = {});

/// Where a TCP link's end is.
struct HostPort {
  std::string host;  ///< name or address, IPv6 without its brackets; empty: none given
  std::uint16_t port = 0;
};

/// Reads `[HOST:]PORT`; IPv6 addresses stand in brackets, `[::1]:7000`.
///
/// Errors: Invalid (no port, a port outside 0 … 65535, an unclosed bracket).
Result<HostPort> parse_host_port(std::string_view text);

}  // namespace hc
