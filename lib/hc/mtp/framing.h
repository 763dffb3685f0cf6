// SPDX-License-Identifier: Apache-2.0
#pragma once
// The parts of a message around its elements, for all readers. Internal. Pure.

#include <cstddef>
#include <cstdint>
#include <string_view>

#include <hc/base/result.h>
#include <hc/mtp/header.h>
#include <hc/mtp/header_memo.h>

namespace hc::internal {

/// Whether the elements are rows of numbers in text, at least one.
inline bool has_rows(const Header& header) {
  return header.info.encoding == Encoding::Text && header.info.type != MatrixType::String &&
         !header.empty();
}

inline bool is_compressed(const Header& header) {
  return header.info.encoding == Encoding::Zstd || header.info.encoding == Encoding::Jpeg;
}

struct HeaderLine {
  Header header;
  std::size_t bytes = 0;  ///< of the line including its end; 0: incomplete
};

/// Parses the header line at the start of `text` (R3 … R24).
/// @param memo  of the stream's headers.
Result<HeaderLine> read_header_line(std::string_view text, const Limits& limits, std::uint64_t byte,
                                    HeaderMemo& memo);

struct LengthLine {
  std::uint64_t length = 0;  ///< of the compressed elements [byte]
  std::size_t bytes = 0;     ///< of the line including its end; 0: incomplete
};

/// Parses the line before compressed elements (R34, R35).
Result<LengthLine> read_length_line(std::string_view text, const Limits& limits,
                                    std::uint64_t byte);

/// Reads the line end after elements that are not rows (R26); returns its size [byte], 0 if it is
/// incomplete.
Result<std::size_t> read_closing(const Header& header, std::string_view text, std::uint64_t byte);

}  // namespace hc::internal
