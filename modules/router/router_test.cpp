// SPDX-License-Identifier: Apache-2.0
#include "router.h"

#include <map>
#include <random>
#include <set>
#include <tuple>

#include <gtest/gtest.h>

namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

hc::Header header(std::int32_t src, std::int64_t seq, int time = 5, std::int32_t dst = 21) {
  hc::Header result;
  result.src = src;
  result.dst = dst;
  result.seq = seq;
  result.time = hc::unix_time(time);
  return result;
}

TEST(SeenBefore, a_message_differs_by_source_address_number_and_time) {
  SeenBefore seen(seconds(1));
  EXPECT_FALSE(seen.insert(header(1, 0), {}));
  EXPECT_TRUE(seen.insert(header(1, 0), {}));
  EXPECT_FALSE(seen.insert(header(2, 0), {}));
  EXPECT_FALSE(seen.insert(header(1, 1), {}));
  EXPECT_FALSE(seen.insert(header(1, 0, 6), {}));
  EXPECT_FALSE(seen.insert(header(1, 0, 5, -1), {}));
  EXPECT_TRUE(seen.insert(header(1, 0), {}));
  EXPECT_TRUE(seen.insert(header(1, 0, 5, -1), {}));
}

TEST(SeenBefore, is_forgotten_after_its_time) {
  SeenBefore seen(seconds(1));
  EXPECT_FALSE(seen.insert(header(1, 0), seconds(5)));
  EXPECT_TRUE(seen.insert(header(1, 0), seconds(6) - milliseconds(1)));
  EXPECT_FALSE(seen.insert(header(1, 0), seconds(6)));
  EXPECT_TRUE(seen.insert(header(1, 0), seconds(6)));
}

TEST(SeenBefore, remembers_the_newest_of_each_source_in_bounded_memory) {
  SeenBefore seen(seconds(1), 256, 1024);
  for (std::int64_t seq = 0; seq < 10'000; ++seq) {
    EXPECT_FALSE(seen.insert(header(1, seq), {}));
    if (seq < 255) continue;
    EXPECT_TRUE(seen.insert(header(1, seq - 255), {})) << seq;
  }
  EXPECT_EQ(seen.room(), 256U);
  EXPECT_TRUE(seen.insert(header(1, 9'999), {}));
  for (std::int32_t src = 2; src < 1000; ++src) EXPECT_FALSE(seen.insert(header(src, 0), {}));
  EXPECT_EQ(seen.room(), 1024U);
  EXPECT_TRUE(seen.insert(header(999, 0), {}));
}

TEST(SeenBefore, a_slow_source_takes_little_room) {
  SeenBefore seen(seconds(1));
  for (std::int64_t seq = 0; seq < 10'000; ++seq)
    EXPECT_FALSE(seen.insert(header(1, seq), milliseconds(100) * seq));
  EXPECT_EQ(seen.room(), 64U);
}

/// Compared with a model of unlimited memory: a new message is never taken for a repetition and,
/// with enough memory, a repetition never for a new message.
TEST(SeenBefore, random_messages_are_judged_as_by_a_memory_without_bound) {
  std::minstd_rand random(7);
  auto pick = [&](int least, int most) {
    return std::uniform_int_distribution(least, most)(random);
  };
  for (bool has_room : {true, false}) {
    SeenBefore seen(seconds(1), has_room ? 1 << 16 : 128, has_room ? 1 << 20 : 512);
    std::map<std::tuple<int, int, std::int64_t, hc::Time>, hc::MonotonicTime> model;
    std::map<int, std::int64_t> next;
    hc::MonotonicTime now{};
    int repeats = 0;
    for (int i = 0; i < 200'000; ++i) {
      now += std::chrono::microseconds(pick(0, 2000));
      int src = pick(1, 40);
      std::int64_t seq =
          pick(0, 3) != 0 ? next[src]++ : std::max<std::int64_t>(0, next[src] - pick(1, 60));
      if (pick(0, 5000) == 0) next[src] = 0;  // has restarted
      auto message = header(src, seq, pick(0, 9) == 0 ? 6 : 5, pick(0, 9) == 0 ? -1 : 21);
      auto [known, fresh] =
          model.try_emplace({message.src, message.dst, message.seq, message.time}, now);
      if (!fresh && now - known->second >= seconds(1)) {
        fresh = true;
        known->second = now;
      }
      bool is_repeat = seen.insert(message, now);
      if (fresh || has_room) {
        ASSERT_EQ(is_repeat, !fresh) << i;
      } else if (!is_repeat) {
        known->second = now;
      }
      repeats += is_repeat ? 1 : 0;
    }
    EXPECT_GT(repeats, has_room ? 10'000 : 100);
    EXPECT_LE(seen.room(), has_room ? 1U << 20 : 512U);
  }
}

TEST(Router, R42_takes_one_off_ttl_and_drops_what_would_have_none) {
  Router router(seconds(1));
  for (std::uint8_t ttl = 0; ttl < 2; ++ttl) {
    auto message = header(1, ttl);
    message.ttl = ttl;
    EXPECT_FALSE(router.admit(message, {}));
    EXPECT_EQ(message.ttl, ttl);
  }
  auto message = header(1, 3);
  for (int routers = 0; routers < 7; ++routers) EXPECT_TRUE(Router(seconds(1)).admit(message, {}));
  EXPECT_EQ(message.ttl, 1);
  EXPECT_FALSE(router.admit(message, {}));
  EXPECT_EQ(router.counts().ttl, 3);
}

TEST(Router, counts_each_message_once_by_its_fate) {
  Router router(seconds(1));
  auto route = [&](hc::Header message, std::size_t links) {
    if (router.admit(message, {})) router.sent(message, links);
  };
  route(header(1, 0), 2);
  route(header(1, 0), 2);
  route(header(1, 1), 0);
  route(header(1, 2, 5, 0), 0);
  route(header(1, 3, 5, 0), 1);
  const RouterCounts& counts = router.counts();
  EXPECT_EQ(counts.total(), 5);
  EXPECT_EQ(counts.text(),
            "2 passed; dropped: 0 ttl, 1 seen before, 1 without a route, 1 without an address");
}

}  // namespace
