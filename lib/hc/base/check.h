// SPDX-License-Identifier: Apache-2.0
#pragma once
// HC_CHECK: aborts where a bug is detected and prints the values that show it. For bugs only, of
// this code or its caller; a failure of files, peers or devices is returned as a Result.

#include <sstream>
#include <string>

namespace hc::internal {

/// Writes one line to standard error and aborts.
[[noreturn]] void check_failed_with(const char* condition, const char* file, int line,
                                    const std::string& values);

template <typename... Values>
[[noreturn]] void check_failed(const char* condition, const char* file, int line,
                               const Values&... values) {
  std::ostringstream text;
  ((text << ' ' << values), ...);
  check_failed_with(condition, file, line, text.str());
}

}  // namespace hc::internal

/// Aborts if `cond` is false, printing file, line, condition and values. Always on.
#define HC_CHECK(cond, ...)                                                               \
  do {                                                                                    \
    if (!(cond)) [[unlikely]]                                                             \
      ::hc::internal::check_failed(#cond, __FILE__, __LINE__ __VA_OPT__(, ) __VA_ARGS__); \
  } while (false)
