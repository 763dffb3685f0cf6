// SPDX-License-Identifier: Apache-2.0
// The test's own program is also that of the processes it starts.
#include <gtest/gtest.h>

#include "roles.h"

int main(int argc, char** argv) {
  int status = hc::testing::run_role({argv, static_cast<std::size_t>(argc)});
  if (status >= 0) return status;
  ::testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
