// SPDX-License-Identifier: Apache-2.0
#include <hc/base/suggestion.h>

#include <gtest/gtest.h>

namespace hc {
namespace {

TEST(Suggestion, IsNearOrNothing) {
  EXPECT_EQ(suggestion("camra", {"depth", "camera"}), ", did you mean \"camera\"?");
  EXPECT_EQ(suggestion("wheel", {"depth", "camera"}), "");
}

}  // namespace
}  // namespace hc
