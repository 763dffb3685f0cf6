// SPDX-License-Identifier: Apache-2.0
#include "late.h"

#include <gtest/gtest.h>

#include <memory>

namespace {

TEST(Late, gives_nothing_before_its_time) {
  Late<std::unique_ptr<int>> late;
  late.put(10, std::make_unique<int>(1));
  EXPECT_EQ(late.take(9), std::nullopt);
  EXPECT_FALSE(late.empty());
  const auto taken = late.take(10);
  ASSERT_TRUE(taken);
  EXPECT_EQ(**taken, 1);
  EXPECT_TRUE(late.empty());
  EXPECT_EQ(late.take(99), std::nullopt);
}

TEST(Late, keeps_the_order_when_less_late_things_follow) {
  Late<int> late;
  late.put(10, 1);
  late.put(5, 2);
  EXPECT_EQ(late.take(7), std::nullopt);
  EXPECT_EQ(late.take(10), 1);
  EXPECT_EQ(late.take(10), 2);
}

}  // namespace
