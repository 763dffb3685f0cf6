// SPDX-License-Identifier: Apache-2.0
#pragma once
// For tests: unwraps results.

#include <optional>
#include <stdexcept>
#include <utility>

#include <hc/base/result.h>

namespace hc {

/// The value of a result; an error is printed and ends the test.
template <typename T>
T must(Result<T> result) {
  if (!result) throw std::runtime_error(result.error().text());
  return std::move(*result);
}
template <typename T>
T must(std::optional<T> value) {
  if (!value) throw std::runtime_error("there is none");
  return std::move(*value);
}
inline void must(const Status& status) {
  if (!status) throw std::runtime_error(status.error().text());
}

/// The error of a result; a value ends the test.
template <typename T>
[[nodiscard]] Error refused(const Result<T>& result) {
  if (result) throw std::runtime_error("it is no error");
  return result.error();
}

}  // namespace hc
