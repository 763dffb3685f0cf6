// SPDX-License-Identifier: Apache-2.0
#include <hc/module/matcher.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <random>
#include <stdexcept>

namespace hc {
namespace {

using Times = std::vector<int>;
using Sets = std::vector<Times>;

Message of_nanoseconds(std::int64_t time) {
  Message message;
  message.header.time = unix_time(time);
  return message;
}

Message of_time(int time) {
  return of_nanoseconds(time);
}

/// A matcher whose sets are kept, by their times.
struct Kept {
  Sets sets;
  Matcher matcher;
  explicit Kept(std::size_t inputs)
      : matcher(inputs, [this](std::span<const Message> set) {
          sets.emplace_back();
          for (const auto& message : set)
            sets.back().push_back(static_cast<int>(unix_nanoseconds(message.header.time)));
        }) {}
  void push(std::size_t input, const Times& times) {
    for (auto time : times) matcher.push(input, of_time(time));
  }
};

/// A set for each time that all inputs have, as often as all have it.
Sets reference(const std::vector<Times>& inputs) {
  Times common = inputs.front();
  for (const auto& times : inputs) {
    Times both;
    std::ranges::set_intersection(common, times, std::back_inserter(both));
    common = both;
  }
  Sets sets;
  for (auto time : common) sets.emplace_back(inputs.size(), time);
  return sets;
}

TEST(Matcher, RandomInputsAreMatchedAsByTheirIntersection) {
  std::mt19937 random(20);
  auto up_to = [&](std::size_t most) {
    return std::uniform_int_distribution<std::size_t>(0, most)(random);
  };
  std::size_t sets = 0;
  for (int round = 0; round < 3000; ++round) {
    std::vector<Times> inputs(2 + up_to(2));
    const std::size_t drops = up_to(4);
    for (auto& times : inputs)
      for (int time = 1; time <= 12; ++time)
        if (up_to(9) >= drops) times.insert(times.end(), 1 + up_to(5) / 5, time);
    Kept kept(inputs.size());
    std::vector<std::size_t> next(inputs.size(), 0), open(inputs.size());
    for (std::size_t i = 0; i < open.size(); ++i) open[i] = i;
    while (!open.empty()) {  // any input is the next, and ends any time after its last
      const std::size_t pick = up_to(open.size() - 1), input = open[pick];
      if (next[input] == inputs[input].size()) {
        kept.matcher.end(input);
        open.erase(open.begin() + static_cast<std::ptrdiff_t>(pick));
      } else if (!kept.matcher.crowded(input)) {
        kept.push(input, {inputs[input][next[input]++]});
      }
    }
    ASSERT_EQ(kept.sets, reference(inputs)) << "round " << round;
    EXPECT_TRUE(kept.matcher.done());
    for (std::size_t i = 0; i < inputs.size(); ++i) {
      EXPECT_EQ(kept.matcher.dropped(i).unmatched + kept.sets.size(), inputs[i].size());
      EXPECT_EQ(kept.matcher.dropped(i).crowded, 0U);
    }
    sets += kept.sets.size();
  }
  EXPECT_GT(sets, 3000U);
}

TEST(Matcher, ASetIsGivenAsSoonAsItIsComplete) {
  Kept kept(3);
  kept.push(0, {1, 2, 3, 5});
  kept.push(1, {2, 4, 5});
  kept.push(2, {2});
  EXPECT_EQ(kept.sets, (Sets{{2, 2, 2}}));
  kept.push(2, {5});
  EXPECT_EQ(kept.sets, (Sets{{2, 2, 2}, {5, 5, 5}}));
  EXPECT_EQ(kept.matcher.dropped(0).unmatched, 2U);
  EXPECT_EQ(kept.matcher.dropped(1).unmatched, 1U);
}

TEST(Matcher, WhatIsOlderThanTheNextOfAnotherInputIsDropped) {
  Kept kept(2);
  kept.push(0, {100, 100});
  kept.push(1, {100, 200});
  kept.push(0, {180, 195});
  EXPECT_EQ(kept.matcher.dropped(0).unmatched, 3U);
  EXPECT_FALSE(kept.matcher.done());
}

TEST(Matcher, WithoutATimeTheOrderDecides) {
  Kept kept(2);
  kept.push(0, {0, 0, 7});
  kept.push(1, {0, 5, 6, 7});
  EXPECT_EQ(kept.sets, (Sets{{0, 0}, {0, 5}, {7, 7}}));
  Kept three(3);
  three.push(0, {0});
  three.push(1, {3, 17});
  three.push(2, {17, 20});
  EXPECT_EQ(three.sets, (Sets{{0, 17, 17}}));
}

TEST(Matcher, TheOldestIsDroppedForRoom) {
  Kept kept(2);
  Times all(Matcher::kMaxWaiting + 2);
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<int>(i + 1);
  kept.push(0, {all.begin(), all.end() - 2});
  EXPECT_TRUE(kept.matcher.crowded(0));
  kept.push(0, {all.end() - 2, all.end()});
  EXPECT_FALSE(kept.matcher.crowded(1));
  kept.push(1, all);
  ASSERT_EQ(kept.sets.size(), Matcher::kMaxWaiting);
  EXPECT_EQ(kept.sets.front(), (Times{3, 3}));
  EXPECT_EQ(kept.matcher.dropped(0).crowded, 2U);
  EXPECT_EQ(kept.matcher.dropped(0).total(), 2U);
  EXPECT_EQ(kept.matcher.dropped(1).unmatched, 2U);
}

TEST(Matcher, LargeMessagesNeedRoomToo) {
  Kept kept(2);
  const std::vector<std::byte> bytes(1);
  for (int time : {1, 2}) {
    Message message = of_time(time);
    message.elements = {bytes.data(), Matcher::kMaxWaitingBytes};  // nobody looks at them
    kept.matcher.push(0, message);
  }
  EXPECT_EQ(kept.matcher.dropped(0).crowded, 1U);
}

TEST(Matcher, AfterTheEndOfAnInputTheRestIsDropped) {
  Kept kept(2);
  kept.push(0, {10, 20});
  kept.matcher.end(0);
  EXPECT_FALSE(kept.matcher.done());
  kept.push(1, {10, 20});
  EXPECT_EQ(kept.sets, (Sets{{10, 10}, {20, 20}}));
  EXPECT_TRUE(kept.matcher.done());
  kept.push(1, {30, 40});
  EXPECT_EQ(kept.matcher.dropped(1).unmatched, 2U);
}

TEST(Matcher, ATimeThatFallsStartsOver) {
  Kept kept(2);
  kept.push(0, {1000, 1100, 1200});
  kept.push(1, {1000});
  EXPECT_EQ(kept.sets, (Sets{{1000, 1000}}));
  kept.push(0, {50});
  EXPECT_EQ(kept.matcher.dropped(0).unmatched, 2U);
  kept.push(1, {50});
  EXPECT_EQ(kept.sets.back(), (Times{50, 50}));
  kept.push(0, {60, 70, 20});
  kept.push(1, {65, 20});  // its writer restarts later
  kept.push(0, {150});
  kept.push(1, {150});
  EXPECT_EQ(kept.sets.back(), (Times{150, 150}));
}

TEST(Matcher, AnInputThatHasEndedMayBeginAgain) {
  Kept kept(2);
  kept.push(0, {10});
  kept.matcher.end(1);
  kept.matcher.begin(1);
  EXPECT_FALSE(kept.matcher.done());
  kept.push(0, {20});
  kept.push(1, {20});
  EXPECT_EQ(kept.sets, (Sets{{20, 20}}));
}

TEST(Matcher, ASetWhoseHandlerFailsIsTaken) {
  Matcher matcher(2, [](auto) { throw std::runtime_error("no"); });
  matcher.push(0, of_time(1));
  EXPECT_THROW(matcher.push(1, of_time(1)), std::runtime_error);
  matcher.push(1, of_time(1));
  EXPECT_EQ(matcher.dropped(0).total(), 0U);
}

TEST(Matcher, SecondsWithoutASetAreNoticed) {
  constexpr int kSecond = 1'000'000'000;
  Kept kept(2);
  const auto push_both = [&](std::int64_t left, std::int64_t right) {
    kept.matcher.push(0, of_nanoseconds(left));
    kept.matcher.push(1, of_nanoseconds(right));
  };
  std::int64_t time = kSecond;
  for (int i = 0; i < 60; ++i, time += kSecond / 20) {
    push_both(time, time + 1);
    EXPECT_FALSE(kept.matcher.is_starving()) << i;
  }
  push_both(time, time + 1);
  EXPECT_TRUE(kept.matcher.is_starving());
  push_both(time + 2, time + 2);
  EXPECT_FALSE(kept.matcher.is_starving());
}

TEST(Matcher, AnInputWithoutMessagesIsNoLackOfSets) {
  Kept kept(2);
  for (std::int64_t i = 1; i < 100; ++i) kept.matcher.push(0, of_nanoseconds(i * 1'000'000'000));
  EXPECT_FALSE(kept.matcher.is_starving());
}

}  // namespace
}  // namespace hc
