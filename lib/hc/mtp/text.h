// SPDX-License-Identifier: Apache-2.0
#pragma once
// Matrices as text: incremental parsing of rows of numbers, and writing in the shortest form
// (spec/mtp-1.md, R27 … R31, R39). Pure.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include <hc/base/result.h>
#include <hc/mtp/header.h>

namespace hc {

inline constexpr std::size_t kMaxNumberBytes = 64;  ///< of a number in text; R31

/// Parses the rows of one matrix from pieces of any size.
class TextRows {
 public:
  TextRows() = default;
  /// @param header  of a message in text encoding; neither a string nor empty.
  explicit TextRows(const Header& header);

  /// Parses the complete numbers of `text` and appends them in binary form.
  ///
  /// @param text  the stream from where the last call stopped. A number is complete once the byte
  ///     after it has been received.
  /// @param byte  offset of `text` in the stream, for errors.
  /// @param numbers  the end of the result so far; has room for the rest of the matrix or for
  ///     text.size() / 2 + 1 numbers.
  /// @returns  bytes of text consumed, none beyond the end of the matrix.
  ///
  /// Errors: Malformed (R27 … R31).
  Result<std::size_t> read(std::string_view text, std::uint64_t byte, std::byte* numbers);

  /// Whether the last row has ended.
  [[nodiscard]] bool done() const { return rows_left_ == 0; }
  /// Numbers read so far.
  [[nodiscard]] std::uint64_t count() const { return count_; }

 private:
  template <typename T>
  Result<std::size_t> read_as(std::string_view text, std::uint64_t byte, T* numbers);

  Scalar scalar_ = Scalar::U8;
  std::uint64_t row_numbers_ = 0;  // numbers per row
  std::uint64_t column_ = 0;       // numbers read of the current row
  std::uint64_t rows_left_ = 0;
  std::uint64_t count_ = 0;
};

/// Appends the rows of a matrix in canonical form, with the closing line feed.
///
/// @param elements  in binary form, aligned for the scalar, as the header says.
void append_text(const Header& header, std::span<const std::byte> elements, std::string& text);

/// Parses one number that fills `token`, spelled as in rows of text, into `number` in binary form.
///
/// Errors: Malformed; the detail is "R28: 256 does not fit into u8".
Status parse_number(std::string_view token, Scalar scalar, std::byte* number);

}  // namespace hc
