// SPDX-License-Identifier: Apache-2.0
#include "wire.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace {

TEST(Wire, passes_bytes_on_at_once) {
  Wire wire(1);
  wire.put(0, "abc", {});
  EXPECT_EQ(wire.next(), 0);
  EXPECT_EQ(wire.take(0), "abc");
  EXPECT_EQ(wire.take(9), "");
  EXPECT_FALSE(wire.next());
}

TEST(Wire, delays_all_alike) {
  Wire wire(1);
  wire.put(0, "ab", {.delay = 0.5});
  wire.put(0.25, "c", {.delay = 0.5});
  EXPECT_EQ(wire.take(0.49), "");
  EXPECT_EQ(wire.take(0.5), "ab");
  EXPECT_EQ(wire.next(), 0.75);
  EXPECT_EQ(wire.take(0.75), "c");
}

TEST(Wire, keeps_the_order_when_the_delay_falls) {
  Wire wire(1);
  wire.put(0, "a", {.delay = 1});
  wire.put(0, "b", {});
  EXPECT_EQ(wire.take(0.5), "");
  EXPECT_EQ(wire.take(1), "ab");
}

TEST(Wire, is_free_at_once_when_it_is_cleared) {
  Wire wire(1);
  wire.put(0, "a", {.delay = 60});
  wire.clear();
  EXPECT_FALSE(wire.next());
  wire.put(1, "b", {});
  EXPECT_EQ(wire.take(1), "b");
}

TEST(Wire, carries_so_many_bytes_a_second) {
  Wire wire(1);
  wire.put(0, std::string(20, 'x'), {.bytes_per_second = 10});
  EXPECT_EQ(wire.take(0.05), "");
  EXPECT_EQ(wire.take(1.01).size(), 10U);
  EXPECT_EQ(wire.take(2.01).size(), 10U);
  wire.put(5, "y", {.bytes_per_second = 10});
  EXPECT_NEAR(*wire.next(), 5.1, 1e-9);
}

TEST(Wire, spoils_its_share_the_same_with_the_same_seed) {
  const std::string all(100'000, 'x');
  auto corrupted = [&](std::uint64_t seed, double share) {
    Wire wire(seed);
    std::string taken;
    for (int i = 0; i < 10; ++i) {
      wire.put(i, all.substr(0, 10'000), {.garbage = share});
      taken += wire.take(i);
    }
    return taken;
  };
  const auto some = corrupted(3, 0.1);
  const auto left = std::count(some.begin(), some.end(), 'x');
  EXPECT_NEAR(static_cast<double>(left), 90'000, 500);  // five standard deviations
  EXPECT_EQ(some, corrupted(3, 0.1));
  EXPECT_NE(some, corrupted(4, 0.1));
  EXPECT_EQ(corrupted(3, 0), all);
  EXPECT_EQ(corrupted(3, 1).find('x'), std::string::npos);
}

TEST(Wire, holds_no_more_than_it_may) {
  Wire wire(1);
  wire.put(0, std::string(10 * Wire::kMostBytes, 'x'), {.delay = 1});
  EXPECT_EQ(wire.take(1).size(), Wire::kMostBytes);
}

}  // namespace
