// SPDX-License-Identifier: Apache-2.0
#pragma once
// A cache for the headers of a stream, most of which differ from the previous one only in seq and
// time: then only these two are parsed or formatted. Internal. Pure.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include <hc/mtp/header.h>

namespace hc::internal {

/// A canonical header line with the positions of seq and time. An instance may either parse or
/// format, since parse() relies on the remembered header being valid, which format() does not
/// check.
class HeaderMemo {
 public:
  /// Same result as parse_header(). Cost: less than half of it if the header repeats.
  Result<Header> parse(std::string_view line, const Limits& limits, std::uint64_t byte);

  /// Same bytes as format_header(), followed by zeros up to the end of the last word.
  std::size_t format(const Header& header, std::span<char, kMaxHeaderBytes> line);

 private:
  /// A number in the line, and the range of numbers with the same count of digits.
  struct Digits {
    std::size_t begin = 0, size = 0;
    std::uint64_t min = 0, max = 0;
  };

  bool matches(std::string_view line) const;
  bool parse_repeated(std::string_view line, Header& header) const;
  void remember(const Header& header);

  static constexpr std::size_t kWords = kMaxHeaderBytes / sizeof(std::uint64_t);
  static constexpr int kPatience = 8;  // different headers, before a new one is remembered

  Header header_;
  std::uint64_t limit_ = 0;  // the limit that the header was checked against [byte]
  std::array<char, kMaxHeaderBytes> line_;
  std::array<char, kMaxHeaderBytes> frame_;  // the line with 0 in place of the digits, and after it
  std::size_t size_ = 0;                     // of the line without line feed; 0: no header yet
  Digits seq_, time_;
  // The line in words, the last of which ends with the line, and masks of the bits to compare.
  std::array<std::uint64_t, kWords> words_, same_;
  int differing_ = kPatience - 2;
};

}  // namespace hc::internal
