// SPDX-License-Identifier: Apache-2.0
#pragma once
// What benchmarks share: they end with a line where something fails, and take times.

#include <cerrno>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <hc/base/result.h>

namespace bench {

[[noreturn]] inline void fail(const std::string& what) {
  std::fprintf(stderr, "%s: %s\n", program_invocation_short_name, what.c_str());
  // Without destructors: those of another thread may wait for what does not come any more.
  std::_Exit(1);
}

template <typename T>
T must(hc::Result<T> result) {
  if (!result) fail(result.error().text());
  return std::move(*result);
}
inline void must(const hc::Status& status) {
  if (!status) fail(status.error().text());
}

inline double milliseconds(const std::function<void()>& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin)
      .count();
}

inline double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace bench
