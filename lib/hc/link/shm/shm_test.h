// SPDX-License-Identifier: Apache-2.0
#pragma once
// What tests of shared memory share: names that nobody else has, and sizes of messages.

#include <hc/testing/socket_link.h>
#include <unistd.h>

#include <string>

namespace hc::testing {

inline constexpr std::int32_t kSmall = 10, kLarge = 100'000;  // elements [byte]

inline std::string fresh_name() {
  static int count = 0;
  return "shm:test-" + std::to_string(::getpid()) + "-" + std::to_string(count++);
}

}  // namespace hc::testing
