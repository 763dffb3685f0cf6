// SPDX-License-Identifier: Apache-2.0
#pragma once
// What tests of shared memory share: names that nobody else has, and sizes of messages.

#include <hc/testing/socket_link.h>
#include <unistd.h>

#include <memory>
#include <string>

namespace hc::testing {

inline constexpr std::int32_t kSmall = 10, kLarge = 100'000;  // elements [byte]

inline std::string fresh_name() {
  static int count = 0;
  return "shm:test-" + std::to_string(::getpid()) + "-" + std::to_string(count++);
}

/// A link whose sink is opened first.
class ShmLink : public ::testing::Test {
 protected:
  void open(const std::string& sink_options = "", const std::string& source_options = "") {
    name_ = fresh_name();
    sink_ = sink_of(name_ + sink_options);
    source_ = source_of(name_ + source_options);
  }

  std::string name_;
  std::unique_ptr<Sink> sink_;
  std::unique_ptr<Source> source_;
};

}  // namespace hc::testing
