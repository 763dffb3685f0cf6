// SPDX-License-Identifier: Apache-2.0
#include <hc/base/format.h>

#include <algorithm>
#include <charconv>
#include <cstddef>

#include <hc/base/check.h>
#include <hc/base/text.h>

namespace hc::internal {
namespace {

constexpr int kNone = -1;

class Formatter {
 public:
  Formatter(std::string_view pattern, std::initializer_list<FormatValue> values)
      : rest_(pattern), next_(values.begin()), end_(values.end()) {}

  std::string run() {
    while (!rest_.empty()) {
      const char c = rest_.front();
      rest_.remove_prefix(1);
      const bool is_brace = c == '{' || c == '}';
      if (is_brace && !skip(c)) {
        HC_CHECK(c == '{', rest_);
        add_field();
      } else {
        text_ += c;
      }
    }
    HC_CHECK(next_ == end_, text_);
    return std::move(text_);
  }

 private:
  struct Field {
    char align = 0, kind = 0;
    bool zeros = false;
    int width = 0, precision = kNone;
  };

  bool skip(char c) {
    if (!rest_.starts_with(c)) return false;
    rest_.remove_prefix(1);
    return true;
  }

  const FormatValue& take() {
    HC_CHECK(next_ != end_, text_);
    return *next_++;
  }

  /// Digits, or `{}`.
  int read_number() {
    if (skip('{')) {
      HC_CHECK(skip('}'), rest_);
      return std::visit(
          [](auto value) {
            if constexpr (std::is_integral_v<decltype(value)>) return static_cast<int>(value);
            return 0;
          },
          take());
    }
    int number = 0;
    const auto read = std::from_chars(rest_.data(), rest_.data() + rest_.size(), number);
    rest_.remove_prefix(static_cast<std::size_t>(read.ptr - rest_.data()));
    return number;
  }

  void add_field() {
    const FormatValue& value = take();
    Field field;
    if (skip(':')) {
      for (char align : {'<', '>'})
        if (skip(align)) field.align = align;
      field.zeros = skip('0');
      field.width = read_number();
      if (skip('.')) field.precision = read_number();
      for (char kind : {'f', 'g', 'x'})
        if (skip(kind)) field.kind = kind;
    }
    HC_CHECK(skip('}'), rest_);
    add_padded(std::visit([&](auto each) { return text_of(each, field); }, value), field,
               std::holds_alternative<std::string_view>(value));
  }

  static std::string text_of(std::string_view text, const Field&) { return std::string(text); }

  static std::string text_of(double number, const Field& field) {
    char text[400];  // the largest f64 has 309 digits before its point
    std::to_chars_result end{};
    const auto form = field.kind == 'f' ? std::chars_format::fixed : std::chars_format::general;
    if (field.kind == 0 && field.precision == kNone)
      end = std::to_chars(text, std::end(text), number);
    else
      end = std::to_chars(text, std::end(text), number, form,
                          field.precision == kNone ? 6 : field.precision);
    return {text, end.ptr};
  }

  template <typename Integer>
  static std::string text_of(Integer number, const Field& field) {
    char text[24];
    return {text, std::to_chars(text, std::end(text), number, field.kind == 'x' ? 16 : 10).ptr};
  }

  void add_padded(const std::string& piece, const Field& field, bool is_text) {
    const auto points = std::count_if(piece.begin(), piece.end(), [](char c) {
      return (static_cast<unsigned char>(c) & 0xC0) != 0x80;  // begins a code point
    });
    const auto missing =
        static_cast<std::size_t>(std::max<std::ptrdiff_t>(field.width - points, 0));
    const bool is_right = field.align == 0 ? !is_text : field.align == '>';
    if (is_right) text_.append(missing, field.zeros ? '0' : ' ');
    text_ += piece;
    if (!is_right) text_.append(missing, ' ');
  }

  std::string_view rest_;
  std::string text_;
  const FormatValue* next_;
  const FormatValue* end_;
};

}  // namespace

std::string format(std::string_view pattern, std::initializer_list<FormatValue> values) {
  return Formatter(pattern, values).run();
}

}  // namespace hc::internal

namespace hc {

std::string hexadecimal(std::span<const unsigned char> bytes) {
  std::string text;
  for (const unsigned char byte : bytes) text += hexadecimal_byte(static_cast<char>(byte));
  return text;
}

}  // namespace hc
