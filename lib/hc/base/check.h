// SPDX-License-Identifier: Apache-2.0
#pragma once
// HC_CHECK: stops the program where a bug shows, with the values that show it.
// For bugs alone, ours or the caller's; what the world can cause returns a Result.

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

/// Aborts with file, line, the condition's text and the values when `cond` is false. Always on.
#define HC_CHECK(cond, ...)                                                               \
  do {                                                                                    \
    if (!(cond)) [[unlikely]]                                                             \
      ::hc::internal::check_failed(#cond, __FILE__, __LINE__ __VA_OPT__(, ) __VA_ARGS__); \
  } while (false)
