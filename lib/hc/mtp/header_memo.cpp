// SPDX-License-Identifier: Apache-2.0
#include <hc/mtp/header_memo.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <utility>

#include <hc/mtp/digits.h>

namespace hc::internal {
namespace {

constexpr std::size_t kWord = sizeof(std::uint64_t);

/// Parses a number as spelled in R5, from 0 to 2⁶³ − 1; false for anything else.
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

/// Writes up to eight characters, the first in the lowest byte, over zeros of `line`. Writes whole
/// aligned words, so that a following read of words gets each from a single store.
void put_word(std::uint64_t word, char* line, std::size_t at) {
  char* to = line + at / kWord * kWord;
  const std::size_t shift = at % kWord * 8;
  auto put = [](char* there, std::uint64_t part) {
    part |= load8(there);
    std::memcpy(there, &part, kWord);
  };
  put(to, word << shift);
  if (shift > 0) put(to + kWord, word >> (64 - shift));
}

void put_number(std::uint64_t number, char* line, std::size_t begin, std::size_t size) {
  constexpr std::uint64_t kTenTo8 = 100'000'000;
  for (; size >= kWord; number /= kTenTo8)
    put_word(digits_of_value(number % kTenTo8), line, begin + (size -= kWord));
  if (size > 0) put_word(digits_of_value(number) >> 8 * (kWord - size), line, begin);
}

}  // namespace

/// Whether the line differs from the remembered one only in the digits of seq and time.
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
  std::int64_t time = 0;
  if (!parse_number(line.data() + time_.begin, time_.size, time)) return false;
  header.time = unix_time(time);
  return parse_number(line.data() + seq_.begin, seq_.size, header.seq);
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
  auto fits = [](const Digits& digits, std::int64_t value) {
    return value >= 0 && static_cast<std::uint64_t>(value) >= digits.min &&
           static_cast<std::uint64_t>(value) <= digits.max;
  };
  const std::int64_t time = unix_nanoseconds(header.time);
  if (size_ > 0 && header == header_ && fits(seq_, header.seq) && fits(time_, time)) {
    for (std::size_t i = 0; i <= size_; i += kWord)
      std::memcpy(line.data() + i, frame_.data() + i, kWord);
    for (auto [digits, value] : {std::pair(&seq_, header.seq), std::pair(&time_, time)})
      put_number(static_cast<std::uint64_t>(value), line.data(), digits->begin, digits->size);
    return size_ + 1;
  }
  auto size = format_header(header, line);
  std::memset(line.data() + size, 0, (kWord - size % kWord) % kWord);
  if (++differing_ >= kPatience) remember(header);
  return size;
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
    Digits digits{begin, end - begin, 0, 9};
    for (std::size_t i = 1; i < digits.size; ++i) {
      digits.min = digits.max + 1;
      digits.max = digits.max * 10 + 9;
    }
    return digits;
  };
  seq_ = field(3);
  time_ = field(5);
  std::array<char, kMaxHeaderBytes> same;
  same.fill('\xff');
  for (auto digits : {seq_, time_})
    std::fill_n(same.begin() + static_cast<std::ptrdiff_t>(digits.begin), digits.size, '\0');
  frame_.fill('\0');
  for (std::size_t i = 0; i <= size_; ++i) frame_[i] = line_[i] & same[i];
  auto words = (size_ + kWord - 1) / kWord;
  for (std::size_t i = 0; i < words; ++i) {
    auto begin = std::min(i * kWord, size_ - kWord);
    words_[i] = load8(line_.data() + begin);
    same_[i] = load8(same.data() + begin);
  }
}

}  // namespace hc::internal
