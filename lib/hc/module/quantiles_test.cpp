// SPDX-License-Identifier: Apache-2.0
#include <hc/module/quantiles.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>
#include <vector>

namespace hc::internal {
namespace {

TEST(Quantiles, AreRightToAnEighth) {
  std::mt19937_64 random(1);
  std::lognormal_distribution<double> durations(10, 3);
  Quantiles quantiles;
  std::vector<std::int64_t> all;
  for (int i = 0; i < 10'000; ++i) {
    all.push_back(static_cast<std::int64_t>(durations(random)));
    quantiles.add(all.back());
  }
  std::sort(all.begin(), all.end());
  for (double part : {0.0, 0.1, 0.5, 0.9, 0.99, 0.999}) {
    auto exact = all[static_cast<std::size_t>(part * 10'000)];
    EXPECT_GE(quantiles.quantile(part), exact) << part;
    EXPECT_LE(quantiles.quantile(part), exact + exact / 8 + 1) << part;
  }
  EXPECT_EQ(quantiles.quantile(1), all.back());
  EXPECT_EQ(quantiles.max(), all.back());
}

TEST(Quantiles, TakeAllThereIs) {
  Quantiles quantiles;
  EXPECT_TRUE(quantiles.empty());
  EXPECT_EQ(quantiles.quantile(0.5), 0);
  for (std::int64_t value = 0; value < 8; ++value) quantiles.add(value);
  EXPECT_EQ(quantiles.quantile(0.5), 4);
  quantiles.clear();
  quantiles.add(-5);
  EXPECT_EQ(quantiles.quantile(0.99), 0);
  quantiles.add(std::numeric_limits<std::int64_t>::max());
  EXPECT_EQ(quantiles.max(), std::numeric_limits<std::int64_t>::max());
  EXPECT_EQ(quantiles.quantile(1), std::numeric_limits<std::int64_t>::max());
}

}  // namespace
}  // namespace hc::internal
