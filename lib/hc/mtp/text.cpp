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

constexpr std::size_t kMaxWritten = 32;  // of a number in canonical form [byte], with a margin

bool is_end(char c) {
  return c == ' ' || c == '\n';
}

/// Whether a valid number out of the range of T is too small rather than too large.
bool is_tiny(const char* first, const char* last) {
  double value = 0;  // has the range for what is only out of range of float
  if (std::from_chars(first, last, value).ec == std::errc()) return std::abs(value) < 1;
  // The digits, at most kMaxNumberBytes, move the point by less than an exponent that is out of
  // range.
  const char* mark = std::find_if(first, last, [](char c) { return c == 'e' || c == 'E'; });
  return mark != last && mark[1] == '-';
}

template <typename T>
Outcome read_float(const char* first, const char* last, T& value, const char*& next) {
  auto [stop, status] = std::from_chars(first, last, value);
  next = stop;
  if (status == std::errc::invalid_argument) return Outcome::NotANumber;
  if (stop[-1] == ')') return Outcome::NotANumber;  // from_chars also accepts nan(…)
  if (status == std::errc::result_out_of_range) {
    if (!is_tiny(first, stop)) return Outcome::OutOfRange;
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
  if constexpr (std::is_integral_v<T>) {
    return internal::write_integer(at, value);
  } else {
    if (std::isnan(value)) [[unlikely]]
      return std::copy_n("nan", 3, at);
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

  // Numbers and line ends, up to an incomplete one.
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
    // The number is invalid or incomplete; if it breaks several rules, report the first in the
    // order of R31.
    const char* token_end = at;
    while (token_end != end && !is_end(*token_end)) ++token_end;
    if (token_end != end && *token_end == '\n' && token_end[-1] == '\r') --token_end;
    std::string_view token(at, static_cast<std::size_t>(token_end - at));
    bool open = token_end == end;  // more of it, or the LF after its CR, may follow
    if (open && token.size() <= kMaxNumberBytes) break;
    if (open && token.size() == kMaxNumberBytes + 1 && token.back() == '\r') break;
    if (token.size() > kMaxNumberBytes)
      return refusal(Code::Malformed, 31, "elements",
                     "a number is longer than 64 bytes: " + in_quotes(token), where(at));
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
  if (header.info.type == MatrixType::String || header.empty()) {
    text.append(reinterpret_cast<const char*>(elements.data()), elements.size());
    text += '\n';
    return;
  }
  visit_scalar(header.info.scalar, [&](auto zero) {
    using T = decltype(zero);
    const T* number = reinterpret_cast<const T*>(elements.data());
    std::uint64_t row_numbers = header.row_numbers();
    // Through a local buffer, since growing the string would fill it with zeros.
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

Status parse_number(std::string_view token, Scalar scalar, std::byte* number) {
  return visit_scalar(scalar, [&](auto value) -> Status {
    const char *const end = token.data() + token.size(), *next = nullptr;
    Outcome outcome = read_number(token.data(), end, value, next);
    if (next != end) outcome = Outcome::NotANumber;
    if (token.size() > kMaxNumberBytes)
      return Error{Code::Malformed, "R31: a number is longer than 64 bytes"};
    if (outcome != Outcome::Good)
      return Error{Code::Malformed, "R" + std::to_string(static_cast<int>(outcome)) + ": " +
                                        describe(outcome, token, scalar)};
    std::memcpy(number, &value, sizeof value);
    return {};
  });
}

}  // namespace hc
