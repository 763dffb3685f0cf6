// SPDX-License-Identifier: Apache-2.0
#pragma once
// Parsing and formatting of the header, eleven integers in plain text (spec/mtp-1.md, section 2).
// Pure.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include <hc/base/result.h>
#include <hc/base/time.h>
#include <hc/mtp/element.h>

namespace hc {

inline constexpr int kVersion = 1;                   ///< of the protocol (R6)
inline constexpr std::size_t kMaxHeaderBytes = 256;  ///< of a header line with its line feed (R3)

/// The metadata of a message. The default is valid: an empty position.
struct Header {
  std::int32_t src = 0;     ///< address of the output port; 0: none
  std::int32_t dst = 0;     ///< > 0: one port, 0: along the links, -1: broadcast, < -1: a group
  std::int64_t seq = 0;     ///< incremented by one for each message of a src
  std::uint8_t ttl = 8;     ///< routers that may still forward it
  Time time;                ///< when the data was measured; Time{}: unknown
  Info info;                ///< type and encoding of the elements
  std::int32_t mode = 0;    ///< system mode of the sender; 0: none
  std::int32_t coord = 0;   ///< coordinate system of the elements; 0: none
  std::int32_t width = 0;   ///< elements per row
  std::int32_t height = 0;  ///< rows

  /// Whether there are no elements: width or height is 0 (R25).
  [[nodiscard]] bool empty() const { return width == 0 || height == 0; }
  /// Size of the elements in binary form. Does not overflow for a header that passed check().
  [[nodiscard]] std::uint64_t element_bytes() const {
    return static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height) *
           info.element_bytes();
  }
  /// Numbers per row.
  [[nodiscard]] std::uint64_t row_numbers() const {
    return static_cast<std::uint64_t>(width) * info.components;
  }

  bool operator==(const Header&) const = default;
};

/// The largest sizes that a reader accepts (R24, R35).
struct Limits {
  std::uint64_t element_bytes = std::uint64_t{256} << 20;
};

/// Parses a header line.
///
/// @param line  the line without its LF or CR LF, at most kMaxHeaderBytes.
/// @param byte  offset of the line in its stream, for errors.
///
/// Errors: Malformed, Unsupported (version, encoding), TooLarge; the detail is
/// "R7 src: -1 is below 0, at byte 2".
/// Cost: no allocation unless it fails.
Result<Header> parse_header(std::string_view line, const Limits& limits = {},
                            std::uint64_t byte = 0);

/// Whether a header made by a program can be sent (R7 … R24).
///
/// Errors: as parse_header, without the byte.
Status check(const Header& header, const Limits& limits = {});

/// Writes the canonical line with its LF; returns the number of bytes, at most 178.
/// A header that check() refuses gives a line that readers refuse.
std::size_t format_header(const Header& header, std::span<char, kMaxHeaderBytes> line);

/// The canonical line without its LF.
std::string text(const Header& header);

}  // namespace hc
