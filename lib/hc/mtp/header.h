// SPDX-License-Identifier: Apache-2.0
#pragma once
// The header: eleven integers in plain text, and back (spec/mtp-1.md, section 2). Pure.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include <hc/base/result.h>
#include <hc/mtp/element.h>

namespace hc {

inline constexpr int kVersion = 1;                   ///< of the protocol; R6
inline constexpr std::size_t kMaxHeaderBytes = 256;  ///< of a header line with its line feed; R3

/// What the sender says of a message. A default header is a valid one, of an empty position.
struct Header {
  std::int32_t src = 0;    ///< address of the output port; 0: none given
  std::int32_t dst = 0;    ///< > 0 one port, 0 follow the link, -1 everybody, < -1 a group
  std::int64_t seq = 0;    ///< counts up by one per src
  std::uint8_t ttl = 8;    ///< routers left to pass
  std::int64_t time = 0;   ///< when the sensed thing happened [ns since the Unix epoch]; 0: unknown
  Info info;               ///< what the elements are
  std::int32_t mode = 0;   ///< system mode of the sender; 0: none
  std::int32_t coord = 0;  ///< coordinate system of the elements; 0: none given
  std::int32_t width = 0;  ///< elements in a row
  std::int32_t height = 0;  ///< rows

  /// No elements at all: width or height is 0 (R25).
  [[nodiscard]] bool empty() const { return width == 0 || height == 0; }
  /// Bytes of the elements in binary form. Does not overflow for a header that passed check().
  [[nodiscard]] std::uint64_t element_bytes() const {
    return static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height) *
           info.element_bytes();
  }
  /// Numbers in a row.
  [[nodiscard]] std::uint64_t row_numbers() const {
    return static_cast<std::uint64_t>(width) * info.components;
  }

  bool operator==(const Header&) const = default;
};

/// Largest sizes that a reader accepts (R24, R35).
struct Limits {
  std::uint64_t element_bytes = std::uint64_t{256} << 20;
};

/// Reads a header line.
///
/// @param line  the line without its LF or CR LF, at most kMaxHeaderBytes.
/// @param byte  where the line is in its stream; errors count from there.
///
/// Errors: Malformed, Unsupported (version, encoding), TooLarge; the detail is
/// "R7 src: -1 is below 0, at byte 2".
/// Cost: no allocation unless it fails.
Result<Header> parse_header(std::string_view line, const Limits& limits = {},
                            std::uint64_t byte = 0);

/// Whether a header that a program made can be sent (R7 … R24).
///
/// Errors: as parse_header, without the byte.
Status check(const Header& header, const Limits& limits = {});

/// Writes the canonical line with its LF; returns the number of bytes, at most 178.
/// A header that check() refuses gives a line that readers refuse.
std::size_t format_header(const Header& header, std::span<char, kMaxHeaderBytes> line);

/// The canonical line without its LF.
std::string text(const Header& header);

}  // namespace hc
