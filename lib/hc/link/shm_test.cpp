// SPDX-License-Identifier: Apache-2.0
#include <hc/link/link_conformance.h>

#include <unistd.h>

namespace hc::testing {
namespace {

std::string fresh_name() {
  static int count = 0;
  return "shm:test-" + std::to_string(::getpid()) + "-" + std::to_string(count++);
}

INSTANTIATE_TEST_SUITE_P(Shm, LinkConformance,
                         ::testing::Values(Transport{"shm",
                                                     [] {
                                                       auto name = fresh_name();
                                                       return std::pair(name + "?wait=10",
                                                                        name + "?readers=1");
                                                     },
                                                     true}),
                         [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace hc::testing
