// SPDX-License-Identifier: Apache-2.0
#pragma once
// The result of a function that can fail: a value, or an Error with the reason.
// Names follow std::expected, which is to replace Result once the compilers have it.

#include <string>
#include <string_view>
#include <utility>
#include <variant>

#include <hc/base/check.h>

namespace hc {

/// The kinds of failure. `doc/reference.md` lists them with their exit statuses.
enum class Code {
  Malformed,    ///< bytes that break a rule of the format
  Unsupported,  ///< a version, encoding, transport or device that this build does not support
  TooLarge,     ///< exceeds a limit
  Truncated,    ///< a stream that ended inside a message
  Closed,       ///< the other side has closed
  Stopped,      ///< this side was asked to stop while it waited
  NotFound,     ///< no such name or file, or the peer never existed
  Invalid,      ///< inconsistent arguments, parameters or graph file
  System,       ///< a system call or a library failed; the detail says which and why
};

/// Name of a code as error lines show it, such as "Malformed".
std::string_view name(Code code);

struct Error {
  Code code = Code::System;
  std::string detail;  ///< one sentence with the values, without a line end

  /// "Malformed: R7 src: -1 is below 0, at byte 2"
  [[nodiscard]] std::string text() const;
};

/// A value of type T, or an Error.
///
///     Result<Header> header = parse_header(line);
///     if (!header) return header.error();
///     use(header->width);
///
/// Taking the value of a failed Result, or the error of a good one, is a bug and aborts.
template <typename T>
class [[nodiscard]] Result {
 public:
  // NOLINTNEXTLINE(google-explicit-constructor): `return value;` is the point
  Result(T value) : state_(std::in_place_index<0>, std::move(value)) {}
  // NOLINTNEXTLINE(google-explicit-constructor): `return error;` is the point
  Result(Error error) : state_(std::in_place_index<1>, std::move(error)) {}

  [[nodiscard]] bool has_value() const { return state_.index() == 0; }
  explicit operator bool() const { return has_value(); }

  T& operator*() & { return value(); }
  const T& operator*() const& { return value(); }
  T&& operator*() && { return std::move(value()); }
  T* operator->() { return &value(); }
  const T* operator->() const { return &value(); }

  [[nodiscard]] T& value() {
    HC_CHECK(has_value(), std::get<1>(state_).text());
    return *std::get_if<0>(&state_);
  }
  [[nodiscard]] const T& value() const {
    HC_CHECK(has_value(), std::get<1>(state_).text());
    return *std::get_if<0>(&state_);
  }
  [[nodiscard]] T value_or(T other) const { return has_value() ? value() : std::move(other); }

  [[nodiscard]] const Error& error() const {
    HC_CHECK(!has_value());
    return *std::get_if<1>(&state_);
  }

 private:
  std::variant<T, Error> state_;
};

/// Success without a value, or an Error.
template <>
class [[nodiscard]] Result<void> : public Result<std::monostate> {
 public:
  Result() : Result<std::monostate>(std::monostate()) {}
  using Result<std::monostate>::Result;
};

using Status = Result<void>;

}  // namespace hc

/// The value of a Result, for functions that return a Result: an error is returned to the caller.
///
///     auto socket = HC_TRY(open_socket(address));
///     HC_TRY(check_name(uri));
///
/// For whole statements and initializers only: leaving a larger expression would skip
/// destructors.
#define HC_TRY(...)                \
  __extension__({                  \
    auto hc_tried = (__VA_ARGS__); \
    if (!hc_tried) [[unlikely]]    \
      return hc_tried.error();     \
    *std::move(hc_tried);          \
  })
