// SPDX-License-Identifier: Apache-2.0
#include <hc/wire/header_memo.h>

#include <algorithm>
#include <cstring>
#include <limits>

#include <hc/wire/digits.h>

namespace hc::internal {
namespace {

constexpr std::size_t kWord = sizeof(std::uint64_t);

/// Reads a number as R5 spells it, from 0 to 2⁶³ − 1; false for anything else.
bool parse_number(const char* at, std::size_t size, std::int64_t& number) {
  if (*at == '0' && size > 1) return false;
  std::uint64_t value = 0;
  for (; size >= kWord; at += kWord, size -= kWord) {
    std::uint64_t word = load8(at);
    if (non_digits(word) != 0) return false;
    value = value * 100'000'000 + value_of_digits(word);
  }
  for (; size > 0; ++at, --size) {
    auto digit = static_cast<unsigned>(*at - '0');
    if (digit > 9) return false;
    value = value * 10 + digit;
  }
  number = static_cast<std::int64_t>(value);
  return value <= static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max());
}

std::size_t count_digits(std::uint64_t value) {
  std::size_t count = 1;
  for (; value >= 10'000; value /= 10'000) count += 4;
  return count + (value >= 10 ? 1 : 0) + (value >= 100 ? 1 : 0) + (value >= 1000 ? 1 : 0);
}

}  // namespace

/// Whether all but the digits of seq and time is as it was.
bool HeaderMemo::matches(std::string_view line) const {
  if (line.size() != size_ || size_ == 0) return false;
  std::size_t i = 0;
  std::uint64_t differences = 0;
  for (; (i + 1) * kWord < size_; ++i)
    differences |= (load8(line.data() + i * kWord) ^ words_[i]) & same_[i];
  return (differences | ((load8(line.data() + size_ - kWord) ^ words_[i]) & same_[i])) == 0;
}

bool HeaderMemo::parse_repeated(std::string_view line, Header& header) const {
  if (!matches(line)) return false;
  header = header_;
  return parse_number(line.data() + seq_.begin, seq_.size, header.seq) &&
         parse_number(line.data() + time_.begin, time_.size, header.time);
}

Result<Header> HeaderMemo::parse(std::string_view line, const Limits& limits, std::uint64_t byte) {
  Result<Header> header = Header{};
  if (limits.element_bytes >= limit_ && parse_repeated(line, *header)) return header;
  header = parse_header(line, limits, byte);
  if (!header || ++differing_ < kPatience) return header;
  remember(*header);
  limit_ = limits.element_bytes;
  if (std::string_view(line_.data(), size_) != line) size_ = 0;  // not in canonical form
  return header;
}

std::size_t HeaderMemo::format(const Header& header, std::span<char, kMaxHeaderBytes> line) {
  header_.seq = header.seq;
  header_.time = header.time;
  auto put = [&](Digits digits, std::int64_t value) {
    auto number = static_cast<std::uint64_t>(value);
    if (value < 0 || count_digits(number) != digits.size) return false;
    char* at = line_.data() + digits.begin + digits.size;
    for (; digits.size >= kWord; digits.size -= kWord, number /= 100'000'000)
      write_8_digits(at -= kWord, number % 100'000'000);
    for (; digits.size > 0; --digits.size, number /= 10)
      *--at = static_cast<char>('0' + number % 10);
    return true;
  };
  if (size_ > 0 && header == header_ && put(seq_, header.seq) && put(time_, header.time)) {
    std::memcpy(line.data(), line_.data(), size_ + 1);
    return size_ + 1;
  }
  size_ = 0;  // its digits may be half written
  if (++differing_ < kPatience) return format_header(header, line);
  remember(header);
  std::memcpy(line.data(), line_.data(), size_ + 1);
  return size_ + 1;
}

void HeaderMemo::remember(const Header& header) {
  differing_ = 0;
  header_ = header;
  size_ = format_header(header, line_) - 1;
  auto field = [&](int number) {
    std::size_t begin = 0;
    for (; number > 0; ++begin)
      if (line_[begin] == ' ') --number;
    auto end = static_cast<std::size_t>(
        std::find(line_.begin() + static_cast<std::ptrdiff_t>(begin), line_.end(), ' ') -
        line_.begin());
    return Digits{begin, end - begin};
  };
  seq_ = field(3);
  time_ = field(5);
  std::array<char, kMaxHeaderBytes> same;
  same.fill('\xff');
  for (auto digits : {seq_, time_})
    std::fill_n(same.begin() + static_cast<std::ptrdiff_t>(digits.begin), digits.size, '\0');
  auto words = (size_ + kWord - 1) / kWord;
  for (std::size_t i = 0; i < words; ++i) {
    auto begin = std::min(i * kWord, size_ - kWord);
    words_[i] = load8(line_.data() + begin);
    same_[i] = load8(same.data() + begin);
  }
}

}  // namespace hc::internal
