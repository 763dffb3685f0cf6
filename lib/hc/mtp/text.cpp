// SPDX-License-Identifier: Apache-2.0
#include <hc/mtp/text.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>

#include <hc/mtp/digits.h>
#include <hc/mtp/refusal.h>

namespace hc {
namespace {

using internal::in_quotes;
using internal::Outcome;
using internal::refusal;

constexpr std::size_t kMaxWritten = 32;  // bytes of a number in canonical form, and room behind it

bool is_end(char c) {
  return c == ' ' || c == '\n';
}

/// Whether a well-spelled number that fits no float is too small for one, rather than too large:
/// whether its first digit that is not 0 is behind the decimal point once that is moved.
bool is_tiny(std::string_view number) {
  std::int64_t places = 0;  // digits before the point, or -zeros behind it
  bool behind_point = false, significant = false;
  std::size_t i = number.starts_with('-') ? 1 : 0;
  for (; i < number.size() && (number[i] | 0x20) != 'e'; ++i) {
    if (number[i] == '.') {
      behind_point = true;
      continue;
    }
    significant = significant || number[i] != '0';
    if (significant && !behind_point) ++places;
    if (!significant && behind_point) --places;
  }
  bool negative_exponent = i + 1 < number.size() && number[i + 1] == '-';
  std::int64_t exponent = 0;
  for (; i < number.size(); ++i)
    if (number[i] >= '0' && number[i] <= '9' && exponent < 1'000'000)
      exponent = exponent * 10 + (number[i] - '0');
  return places + (negative_exponent ? -exponent : exponent) <= 0;
}

template <typename T>
Outcome read_float(const char* first, const char* last, T& value, const char*& next) {
  auto [stop, status] = std::from_chars(first, last, value);
  next = stop;
  if (status == std::errc::invalid_argument) return Outcome::NotANumber;
  if (stop[-1] == ')') return Outcome::NotANumber;  // from_chars also knows nan(…)
  if (status == std::errc::result_out_of_range) {
    if (!is_tiny({first, static_cast<std::size_t>(stop - first)})) return Outcome::OutOfRange;
    value = static_cast<T>(*first == '-' ? -0.0 : 0.0);
  }
  return Outcome::Good;
}

template <typename T>
Outcome read_number(const char* first, const char* last, T& value, const char*& next) {
  if constexpr (std::is_integral_v<T>)
    return internal::read_integer(first, last, value, next);
  else
    return read_float(first, last, value, next);
}

template <typename T>
char* write_number(char* at, T value) {
  if constexpr (std::is_unsigned_v<T>) {
    return internal::write_digits(at, value);
  } else if constexpr (std::is_integral_v<T>) {
    return internal::write_integer(at, value);
  } else {
    if (std::isnan(value)) [[unlikely]] {
      return std::copy_n("nan", 3, at);
    }
    return std::to_chars(at, at + kMaxWritten, value).ptr;
  }
}

std::string describe(Outcome outcome, std::string_view token, Scalar scalar) {
  std::string scalar_name{name(scalar)};
  if (outcome == Outcome::OutOfRange)
    return std::string(token) + " does not fit into " + scalar_name;
  return in_quotes(token) + " is not a number of " + scalar_name;
}

}  // namespace

TextRows::TextRows(const Header& header)
    : scalar_(header.info.scalar),
      row_numbers_(header.row_numbers()),
      rows_left_(static_cast<std::uint64_t>(header.height)) {}

template <typename T>
Result<std::size_t> TextRows::read_as(std::string_view text, std::uint64_t byte, T* numbers) {
  const char* const begin = text.data();
  const char* const end = begin + text.size();
  const char* at = begin;
  auto where = [&](const char* here) { return byte + static_cast<std::uint64_t>(here - begin); };

  // The numbers and line ends one after the other, up to one that is not whole.
  while (rows_left_ > 0) {
    while (at != end && *at == ' ') ++at;
    if (at == end) break;

    bool carriage_return = *at == '\r' && (end - at == 1 || at[1] == '\n');
    if (carriage_return && end - at == 1) break;
    if (*at == '\n' || carriage_return) {
      if (column_ < row_numbers_)
        return refusal(Code::Malformed, 29, "elements",
                       "a row ends after " + std::to_string(column_) + " of " +
                           std::to_string(row_numbers_) + " numbers",
                       where(at));
      at += carriage_return ? 2 : 1;
      column_ = 0;
      --rows_left_;
      continue;
    }

    const char* next = at;
    T value{};
    Outcome outcome = Outcome::Good;
    if (column_ < row_numbers_) [[likely]] {
      outcome = read_number(at, end, value, next);
      bool whole = next != end && (is_end(*next) || (*next == '\r' && end - next > 1));
      if (outcome == Outcome::Good && whole && next - at <= std::ptrdiff_t{kMaxNumberBytes} &&
          (*next != '\r' || next[1] == '\n')) [[likely]] {
        std::memcpy(numbers++, &value, sizeof value);
        ++column_;
        ++count_;
        at = next + (*next == ' ' ? 1 : 0);
        continue;
      }
    }
    // Something is wrong with the number, or it is not whole; of several faults the first rule in
    // the order of R31 is named.
    const char* token_end = at;
    while (token_end != end && !is_end(*token_end)) ++token_end;
    if (token_end != end && *token_end == '\n' && token_end[-1] == '\r') --token_end;
    std::string_view token(at, static_cast<std::size_t>(token_end - at));
    bool open = token_end == end;  // more of it may come, or the LF to a CR at its end
    if (open && token.size() <= kMaxNumberBytes) break;
    if (open && token.size() == kMaxNumberBytes + 1 && token.back() == '\r') break;
    if (token.size() > kMaxNumberBytes)
      return refusal(Code::Malformed, 31, "elements",
                     "a number is at most 64 bytes long, not as " + in_quotes(token), where(at));
    if (column_ == row_numbers_)
      return refusal(
          Code::Malformed, 30, "elements",
          in_quotes(token) + " is one number too many for a row of " + std::to_string(row_numbers_),
          where(at));
    if (outcome != Outcome::OutOfRange || next != token_end) outcome = Outcome::NotANumber;
    return refusal(Code::Malformed, static_cast<int>(outcome), "elements",
                   describe(outcome, token, scalar_), where(at));
  }
  return static_cast<std::size_t>(at - begin);
}

Result<std::size_t> TextRows::read(std::string_view text, std::uint64_t byte, std::byte* numbers) {
  return visit_scalar(scalar_, [&](auto zero) {
    return read_as(text, byte, reinterpret_cast<decltype(zero)*>(numbers));
  });
}

void append_text(const Header& header, std::span<const std::byte> elements, std::string& text) {
  if (header.info.type == MatrixType::String) {
    text.append(reinterpret_cast<const char*>(elements.data()), elements.size());
    text += '\n';
    return;
  }
  if (header.empty()) {
    text += '\n';
    return;
  }
  visit_scalar(header.info.scalar, [&](auto zero) {
    using T = decltype(zero);
    const T* number = reinterpret_cast<const T*>(elements.data());
    std::uint64_t row_numbers = header.row_numbers();
    // Numbers go through a piece of memory of our own, so that the string need not be filled with
    // zeros first.
    constexpr std::size_t kPiece = 4096;
    char piece[kPiece];
    char* at = piece;
    for (std::int32_t row = 0; row < header.height; ++row) {
      for (std::uint64_t column = 0; column < row_numbers; ++column) {
        if (at > piece + kPiece - kMaxWritten - 1) {
          text.append(piece, at);
          at = piece;
        }
        at = write_number(at, *number++);
        *at++ = ' ';
      }
      at[-1] = '\n';
    }
    text.append(piece, at);
  });
}

template <ScalarType T>
void append_number(T value, std::string& text) {
  char written[kMaxWritten];
  text.append(written, write_number(written, value));
}

template <ScalarType T>
Result<T> parse_number(std::string_view token) {
  const char* next = nullptr;
  T value{};
  const char* end = token.data() + token.size();
  Outcome outcome =
      token.empty() ? Outcome::NotANumber : read_number(token.data(), end, value, next);
  if (outcome != Outcome::NotANumber && next != end) outcome = Outcome::NotANumber;
  if (token.size() > kMaxNumberBytes)
    return Error{Code::Malformed, "R31: a number is at most 64 bytes long"};
  if (outcome == Outcome::Good) return value;
  return Error{Code::Malformed, "R" + std::to_string(static_cast<int>(outcome)) + ": " +
                                    describe(outcome, token, scalar_for<T>())};
}

#define HC_INSTANTIATE(T)                          \
  template void append_number<T>(T, std::string&); \
  template Result<T> parse_number<T>(std::string_view);
HC_INSTANTIATE(std::uint8_t)
HC_INSTANTIATE(std::int8_t)
HC_INSTANTIATE(std::uint16_t)
HC_INSTANTIATE(std::int16_t)
HC_INSTANTIATE(std::uint32_t)
HC_INSTANTIATE(std::int32_t)
HC_INSTANTIATE(std::uint64_t)
HC_INSTANTIATE(std::int64_t)
HC_INSTANTIATE(float)
HC_INSTANTIATE(double)
#undef HC_INSTANTIATE

}  // namespace hc
