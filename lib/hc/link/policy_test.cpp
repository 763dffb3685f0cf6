// SPDX-License-Identifier: Apache-2.0
#include <hc/link/policy.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <hc/link/queue.h>

namespace hc::internal {
namespace {

using std::chrono::milliseconds;
using std::chrono::nanoseconds;
using std::chrono::seconds;

constexpr TimePoint kBegin{std::chrono::hours(1000)};

Result<Policy> policy_of(const std::string& options) {
  return parse_policy(*parse_uri("tcp:host:1" + options));
}

TEST(Policy, TheWriterWaitsUnlessAskedOtherwise) {
  auto policy = policy_of("");
  EXPECT_TRUE(policy->writer_waits());
  EXPECT_EQ(policy->rate, 0U);
  EXPECT_EQ(policy->memory, 64U << 20);
  EXPECT_TRUE(policy_of("?keep=all")->writer_waits());
}

TEST(Patience, IsOverWhenAReaderTakesNothingForTheTimeout) {
  Patience patience(seconds(5));
  EXPECT_TRUE(patience.waits(7, kBegin));
  EXPECT_EQ(patience.due(), kBegin + seconds(5));
  EXPECT_TRUE(patience.waits(8, kBegin + seconds(4))) << "it has taken one";
  EXPECT_TRUE(patience.waits(8, kBegin + seconds(8)));
  EXPECT_FALSE(patience.waits(8, kBegin + seconds(9)));
  EXPECT_TRUE(patience.is_over(8));
  EXPECT_FALSE(patience.is_over(9)) << "it takes messages again";
  EXPECT_FALSE(patience.is_over(9));
}

TEST(Patience, CountsFromTheBeginningOfEachWait) {
  Patience patience(seconds(5));
  EXPECT_TRUE(patience.waits(7, kBegin));
  patience.end();
  EXPECT_TRUE(patience.waits(7, kBegin + seconds(60)));
  EXPECT_FALSE(patience.waits(7, kBegin + seconds(65)));
}

TEST(Patience, WithoutATimeoutItIsEndless) {
  Patience patience(seconds(0));
  EXPECT_TRUE(patience.waits(7, kBegin));
  EXPECT_TRUE(patience.waits(7, kBegin + std::chrono::hours(100)));
  EXPECT_EQ(patience.due(), TimePoint::max());
}

TEST(Patience, TellsOfALongWaitAndItsEnd) {
  std::vector<bool> told;
  Patience patience(seconds(5), [&](bool waits) { told.push_back(waits); });
  EXPECT_TRUE(patience.waits(7, kBegin));
  EXPECT_EQ(patience.due(), kBegin + Patience::kLong);
  patience.end();
  EXPECT_TRUE(told.empty()) << "it was short";
  EXPECT_TRUE(patience.waits(7, kBegin));
  EXPECT_TRUE(patience.waits(7, kBegin + Patience::kLong));
  EXPECT_EQ(told, std::vector<bool>{true});
  EXPECT_FALSE(patience.waits(7, kBegin + seconds(5)));
  EXPECT_EQ(told, (std::vector<bool>{true, false}));
}

TEST(Policy, IsReadFromOptions) {
  auto policy = policy_of("?keep=5&rate=30&burst=3&memory=1G");
  ASSERT_TRUE(policy) << policy.error().text();
  EXPECT_EQ(policy->keep, 5U);
  EXPECT_EQ(policy->rate, 30U);
  EXPECT_EQ(policy->burst, 3U);
  EXPECT_EQ(policy->memory, 1U << 30);
  EXPECT_EQ(policy_of("?keep=latest")->keep, 1U);
  EXPECT_EQ(policy_of("?memory=7K")->memory, 7U << 10);
  EXPECT_EQ(policy_of("")->timeout, seconds(0));
  EXPECT_EQ(policy_of("?timeout=5")->timeout, seconds(5));
}

TEST(Policy, WhatMakesNoSenseIsRefused) {
  for (const char* options :
       {"?keep=0", "?keep=-1", "?keep=newest", "?keep=1K", "?rate=0", "?rate=x", "?rate=3M",
        "?burst=1.5", "?memory=3T", "?memory=K", "?memory=5G", "?memory=4294967297"})
    EXPECT_EQ(policy_of(options).error().code, Code::Invalid) << options;
  EXPECT_EQ(policy_of("?keep=x").error().detail,
            "option keep is all, latest, or a number of messages");
}

TEST(TokenBucket, WithoutARateThereIsNoLimit) {
  TokenBucket bucket(0, 1);
  for (int i = 0; i < 10; ++i) {
    EXPECT_EQ(bucket.ready_at(kBegin), kBegin);
    bucket.take(kBegin);
  }
}

TEST(TokenBucket, ABurstThenTheRateToTheNanosecond) {
  TokenBucket bucket(3, 2);
  TimePoint now = kBegin;
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(bucket.ready_at(now), now);
    bucket.take(now);
  }
  // Thirds of a second accumulate no error: after n seconds, 3 n tokens have been added.
  for (int i = 1; i <= 300; ++i) {
    now = bucket.ready_at(now);
    EXPECT_EQ(now, kBegin + nanoseconds((1'000'000'000LL * i + 2) / 3)) << i;
    EXPECT_GT(bucket.ready_at(now - nanoseconds(1)), now - nanoseconds(1));
    bucket.take(now);
  }
}

TEST(TokenBucket, IsNeverFullerThanTheBurst) {
  TokenBucket bucket(10, 4);
  TimePoint now = kBegin + std::chrono::hours(24 * 365 * 100);
  bucket.take(kBegin);
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(bucket.ready_at(now), now);
    bucket.take(now);
  }
  EXPECT_EQ(bucket.ready_at(now), now + milliseconds(100));
}

TEST(TokenBucket, NothingOverflows) {
  TokenBucket bucket(TokenBucket::kMost, TokenBucket::kMost);
  bucket.take(kBegin);
  const auto late = kBegin + std::chrono::hours(1'000'000);
  EXPECT_EQ(bucket.ready_at(late), late);
}

TEST(TokenBucket, AClockThatStandsStillGivesNothing) {
  TokenBucket bucket(1000, 1);
  bucket.take(kBegin);
  EXPECT_EQ(bucket.ready_at(kBegin - seconds(1)), kBegin - seconds(1) + milliseconds(1));
}

/// Pushes messages 0, 1, … of `bytes` each; returns those left in the queue.
std::vector<int> left_of(SendQueue<int>& queue, int count, std::uint64_t bytes, Traffic& traffic) {
  for (int i = 0; i < count; ++i) queue.push(i, bytes, traffic);
  std::vector<int> left;
  while (!queue.empty()) left.push_back(queue.pop(kBegin));
  return left;
}

TEST(Policy, ABandwidthIsInBytesOrBits) {
  for (const auto& [text, bytes] :
       std::vector<std::pair<std::string, std::uint64_t>>{{"2 MB/s", 2'000'000},
                                                          {"2MB/s", 2'000'000},
                                                          {"500 kB/s", 500'000},
                                                          {"0.5 MB/s", 500'000},
                                                          {"5 Mbit/s", 625'000},
                                                          {"8kbit/s", 1000},
                                                          {"4 GB/s", 4'000'000'000},
                                                          {"1500", 1500}}) {
    const auto bandwidth = parse_bandwidth(text);
    ASSERT_TRUE(bandwidth) << bandwidth.error().detail;
    EXPECT_EQ(*bandwidth, bytes) << text;
  }
  for (const char* text : {"", "2M", "2 MB", "MB/s", "-1 MB/s", "1e9", "999", "5 GB/s", "2 mb/s",
                           "2 MB/s ", "1.2.3 MB/s", "nan", "99999999999999999999 B/s"})
    EXPECT_FALSE(parse_bandwidth(text)) << text;
  EXPECT_EQ(policy_of("?bandwidth=2M").error().detail,
            "option bandwidth is from 1 kB/s to 4 GB/s, as in 500 kB/s, 2 MB/s or 5 Mbit/s, not "
            "\"2M\"");
  EXPECT_TRUE(policy_of("?bandwidth=2MB/s")->is_paced());
}

TEST(Pace, NoSecondHasMoreThanTheBandwidthAndABurst) {
  Pace pace(*policy_of("?bandwidth=1MB/s"));
  constexpr std::uint64_t kSize = 1000;
  std::vector<TimePoint> passed;
  for (auto now = kBegin; passed.size() < 5000;) {
    pace.take(now, kSize);
    passed.push_back(now);
    now = std::max(now, pace.ready_at(now, kSize));
    if (passed.size() == 2500) now += seconds(10);  // a pause does not add up
  }
  std::size_t most = 0, begin = 0;
  for (std::size_t i = 0; i < passed.size(); ++i) {
    while (passed[i] - passed[begin] >= seconds(1)) ++begin;
    most = std::max(most, i - begin + 1);
  }
  EXPECT_GT(most * kSize, 999'000U);
  EXPECT_LE(most * kSize, 1'027'000U);
}

TEST(Pace, AMessageLargerThanABurstPassesAlone) {
  Pace pace(*policy_of("?bandwidth=1MB/s"));
  EXPECT_EQ(pace.ready_at(kBegin, 5'000'000), kBegin);
  pace.take(kBegin, 5'000'000);
  EXPECT_EQ(pace.ready_at(kBegin, 1),
            kBegin + seconds(5) - milliseconds(25) + std::chrono::microseconds(1));
  EXPECT_EQ(pace.ready_at(kBegin, 5'000'000), kBegin + seconds(5));
}

TEST(SendQueue, BytesAreHeldBackToo) {
  Traffic traffic;
  SendQueue<int> queue(*policy_of("?keep=latest&bandwidth=1MB/s"));
  EXPECT_TRUE(queue.pass(kBegin, 100'000));
  EXPECT_FALSE(queue.pass(kBegin, 1000));
  queue.push(1, 1000, traffic);
  EXPECT_EQ(queue.ready_at(kBegin, traffic), kBegin + milliseconds(76));
  queue.push(2, 1000, traffic);
  EXPECT_EQ(traffic.throttled, 1U);
  EXPECT_EQ(queue.pop(kBegin + milliseconds(76)), 2);
}

TEST(SendQueue, CountsMessagesThatShareAnItem) {
  Traffic traffic;
  SendQueue<int> queue(*policy_of(""));
  queue.push(0, 10, traffic);
  queue.push(1, 10, traffic);
  queue.grow_last(5);
  EXPECT_EQ(queue.messages(), 3U);
  EXPECT_EQ(queue.bytes(), 25U);
  EXPECT_EQ(queue.pop(kBegin), 0);
  EXPECT_EQ(queue.clear(traffic), 2U);
  EXPECT_EQ(queue.messages(), 0U);
}

TEST(SendQueue, KeepsAllThatAreToBeKept) {
  Traffic traffic;
  SendQueue<int> queue(*policy_of(""));
  EXPECT_EQ(left_of(queue, 1000, 10, traffic).size(), 1000U);
  EXPECT_EQ(traffic.dropped_newer, 0U);
  EXPECT_EQ(queue.bytes(), 0U);
}

TEST(SendQueue, DropsTheOldestAndCountsThem) {
  Traffic traffic;
  SendQueue<int> queue(*policy_of("?keep=3"));
  EXPECT_EQ(left_of(queue, 10, 10, traffic), (std::vector<int>{7, 8, 9}));
  EXPECT_EQ(traffic.dropped_newer, 7U);
  EXPECT_EQ(
      traffic.delayed + traffic.throttled + traffic.dropped_memory + traffic.dropped_disconnect,
      0U);
}

TEST(SendQueue, IsBoundedInMemoryToo) {
  Traffic traffic;
  SendQueue<int> queue(*policy_of("?keep=100&memory=1K"));
  EXPECT_EQ(left_of(queue, 10, 300, traffic), (std::vector<int>{7, 8, 9}));
  EXPECT_EQ(traffic.dropped_memory, 7U);
  EXPECT_EQ(traffic.dropped_newer, 0U);
}

TEST(SendQueue, DropsNothingForMemoryWhereAllAreKept) {
  Traffic traffic;
  SendQueue<int> queue(*policy_of("?memory=1K"));
  EXPECT_TRUE(queue.has_memory(5000));
  queue.push(0, 5000, traffic);
  EXPECT_FALSE(queue.has_memory(1));
  queue.push(1, 5000, traffic);
  EXPECT_EQ(queue.messages(), 2U);
  EXPECT_EQ(traffic.dropped_memory, 0U);
}

TEST(SendQueue, TheNewestStaysHoweverLarge) {
  Traffic traffic;
  SendQueue<int> queue(*policy_of("?keep=100&memory=1K"));
  EXPECT_EQ(left_of(queue, 3, 5000, traffic), std::vector<int>{2});
  EXPECT_EQ(traffic.dropped_memory, 2U);
}

TEST(SendQueue, WhatThePaceKeepsBackIsCountedOnce) {
  Traffic traffic;
  SendQueue<int> queue(*policy_of("?keep=2&rate=10&burst=2"));
  EXPECT_TRUE(queue.pass(kBegin, 1));
  EXPECT_TRUE(queue.pass(kBegin, 1));
  ASSERT_FALSE(queue.pass(kBegin, 1));
  for (int i = 0; i < 5; ++i) {
    queue.push(i, 1, traffic);
    EXPECT_EQ(queue.ready_at(kBegin, traffic), kBegin + milliseconds(100));
    EXPECT_EQ(queue.ready_at(kBegin, traffic), kBegin + milliseconds(100));
  }
  EXPECT_EQ(traffic.delayed, 5U);
  EXPECT_EQ(traffic.throttled, 3U);
  EXPECT_EQ(traffic.dropped_newer, 0U);
  auto now = kBegin + milliseconds(100);
  EXPECT_EQ(queue.ready_at(now, traffic), now);
  EXPECT_EQ(queue.pop(now), 3);
  EXPECT_EQ(queue.ready_at(now, traffic), now + milliseconds(100));
  EXPECT_EQ(traffic.delayed, 5U);
}

TEST(SendQueue, OneThatNobodyHoldsBackIsSuperseded) {
  Traffic traffic;
  SendQueue<int> queue(*policy_of("?keep=1&rate=10"));
  queue.push(0, 1, traffic);  // ready, but the link has no room
  EXPECT_EQ(queue.ready_at(kBegin, traffic), kBegin);
  queue.push(1, 1, traffic);
  EXPECT_EQ(traffic.dropped_newer, 1U);
  EXPECT_EQ(traffic.delayed + traffic.throttled, 0U);
  EXPECT_EQ(queue.ready_at(kBegin, traffic), kBegin);
}

TEST(SendQueue, OneMayBeTakenBack) {
  Traffic traffic;
  SendQueue<int> queue(*policy_of(""));
  queue.push(0, 5, traffic);
  queue.push(1, 6, traffic);
  queue.take_back();
  EXPECT_EQ(queue.bytes(), 5U);
  EXPECT_EQ(queue.front(), 0);
  EXPECT_EQ(queue.clear(traffic), 1U);
  EXPECT_EQ(queue.ready_at(kBegin, traffic), TimePoint::max());
}

}  // namespace
}  // namespace hc::internal
