// SPDX-License-Identifier: Apache-2.0
#include <graph/plan/routes.h>

#include <gtest/gtest.h>

#include <algorithm>

namespace hc::internal {
namespace {

using Passed = std::vector<std::vector<std::int64_t>>;

/// Indices of modules that are not routers.
constexpr std::size_t kRouters = 10;

Passed compute(const std::vector<RoutedLink>& links, std::size_t routers) {
  std::vector<bool> is_router(2 * kRouters);
  for (std::size_t i = 0; i < routers; ++i) is_router[i] = true;
  return compute_routes(links, is_router).passed;
}

TEST(Routes, OneRouterPassesToEachItsOwn) {
  auto routes = compute({{10, 0, 0, {}}, {0, 11, 21, {}}, {0, 12, 22, {}}}, 1);
  EXPECT_EQ(routes, (Passed{{}, {-1, 21}, {-1, 22}}));
}

TEST(Routes, ATreeLeadsDownAndUp) {
  // 0 above 1 and 2, each with a leaf.
  auto routes = compute({{0, 1, 0, {}},
                         {0, 2, 0, {}},
                         {1, 0, 0, {}},
                         {2, 0, 0, {}},
                         {1, 11, 21, {}},
                         {2, 12, 22, {}}},
                        3);
  EXPECT_EQ(routes, (Passed{{-1, 21}, {-1, 22}, {-1, 22}, {-1, 21}, {-1, 21}, {-1, 22}}));
}

TEST(Routes, ARingGoesTheShorterWayAndOfTwoTheFirst) {
  // 0 - 1 - 2 - 3 - 0, both ways; a leaf at each.
  std::vector<RoutedLink> links;
  for (std::size_t i = 0; i < 4; ++i) {
    links.push_back({i, (i + 1) % 4, 0, {}});
    links.push_back({i, (i + 3) % 4, 0, {}});
    links.push_back({i, kRouters + i, static_cast<std::int64_t>(20 + i), {}});
  }
  auto routes = compute(links, 4);
  EXPECT_EQ(routes[0], (std::vector<std::int64_t>{-1, 21, 22}));  // two hops either way: this one
  EXPECT_EQ(routes[1], (std::vector<std::int64_t>{-1, 23}));
  EXPECT_EQ(routes[2], (std::vector<std::int64_t>{-1, 20}));
  for (std::size_t router = 0; router < 4; ++router) {  // each address by one link of a router
    std::vector<std::int64_t> addresses;
    for (std::size_t i = 3 * router; i < 3 * router + 3; ++i)
      for (auto address : routes[i])
        if (address > 0) addresses.push_back(address);
    std::sort(addresses.begin(), addresses.end());
    EXPECT_EQ(addresses, (std::vector<std::int64_t>{20, 21, 22, 23}));
  }
}

TEST(Routes, AOneWayRingLeadsRound) {
  auto routes = compute({{0, 1, 0, {}}, {1, 2, 0, {}}, {2, 0, 0, {}}, {0, 10, 20, {}}}, 3);
  EXPECT_EQ(routes, (Passed{{-1}, {-1, 20}, {-1, 20}, {-1, 20}}));
}

TEST(Routes, WhatTheFileSaysIsPassedAndLedTo) {
  auto routes = compute({{0, 1, 0, {}}, {1, kOutside, 0, std::vector<std::int64_t>{70, -5}}}, 2);
  EXPECT_EQ(routes, (Passed{{-1, 70}, {70, -5}}));
}

TEST(Routes, AnInputThatTwoRoutersReachIsReachedByTheNearer) {
  auto routes = compute({{0, 1, 0, {}}, {1, 10, 20, {}}, {0, 10, 20, {}}}, 2);
  EXPECT_EQ(routes, (Passed{{-1}, {-1, 20}, {-1, 20}}));
}

TEST(Routes, TheLongestWayIsCountedInRouters) {
  EXPECT_EQ(compute_routes({{0, 1, 0, {}}, {1, 2, 0, {}}, {2, 10, 20, {}}, {0, 10, 21, {}}},
                           {true, true, true})
                .longest,
            3U);
  EXPECT_EQ(compute_routes({{0, 10, 20, {}}}, {false}).longest, 0U);
}

}  // namespace
}  // namespace hc::internal
