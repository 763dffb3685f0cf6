// SPDX-License-Identifier: Apache-2.0
#include <hc/base/check.h>

#include <unistd.h>

#include <cstdlib>

namespace hc::internal {

void check_failed_with(const char* condition, const char* file, int line,
                       const std::string& values) {
  std::string text = std::string(file) + ":" + std::to_string(line) +
                     ": check failed: " + condition + (values.empty() ? "" : ":") + values + "\n";
  // If this write fails, the bug cannot be reported in any other way.
  [[maybe_unused]] auto written = ::write(STDERR_FILENO, text.data(), text.size());
  std::abort();
}

}  // namespace hc::internal
