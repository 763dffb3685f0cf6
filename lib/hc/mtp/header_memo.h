// SPDX-License-Identifier: Apache-2.0
#pragma once
// Headers of one stream, of which nearly each is as the one before but for seq and time: then these
// two alone are read, or written. Internal. Pure.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include <hc/mtp/header.h>

namespace hc::internal {

/// A canonical header line, and where in it seq and time stand. Each is for one direction: parse()
/// takes what it remembers for checked, which format() does not do.
class HeaderMemo {
 public:
  /// parse_header(), to the letter. Cost: less than half of it where the memo helps.
  Result<Header> parse(std::string_view line, const Limits& limits, std::uint64_t byte);

  /// format_header(), to the byte; with zeros behind it to the end of the last word.
  std::size_t format(const Header& header, std::span<char, kMaxHeaderBytes> line);

 private:
  /// A number in the line, and those that are spelt with as many digits.
  struct Digits {
    std::size_t begin = 0, size = 0;
    std::uint64_t min = 0, max = 0;
  };

  bool matches(std::string_view line) const;
  bool parse_repeated(std::string_view line, Header& header) const;
  void remember(const Header& header);

  static constexpr std::size_t kWords = kMaxHeaderBytes / sizeof(std::uint64_t);
  static constexpr int kPatience = 8;  // headers that differ, until another one is remembered

  Header header_;
  std::uint64_t limit_ = 0;  // that the header has been found to keep [byte]
  std::array<char, kMaxHeaderBytes> line_;
  std::array<char, kMaxHeaderBytes> frame_;  // the line, but 0 for the digits and beyond it
  std::size_t size_ = 0;  // of the line without its line feed; 0: nothing is remembered
  Digits seq_, time_;
  // The line in words, the last of which ends with it, and which bits of them are to be the same.
  std::array<std::uint64_t, kWords> words_, same_;
  int differing_ = kPatience - 2;
};

}  // namespace hc::internal
