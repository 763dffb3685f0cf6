// SPDX-License-Identifier: Apache-2.0
#include <hc/module/matcher.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <random>

namespace hc {
namespace {

using Times = std::vector<std::int64_t>;
using Sets = std::vector<Times>;

Message at(std::int64_t time) {
  Message message;
  message.header.time = time;
  return message;
}

/// A matcher whose sets are kept, by their times.
struct Kept {
  Sets sets;
  Matcher matcher;
  Kept(std::size_t inputs, std::int64_t within, std::size_t max_waiting = 16)
      : matcher(inputs, {std::chrono::nanoseconds(within), max_waiting},
                [this](std::span<const Message> set) {
                  sets.emplace_back();
                  for (const auto& message : set) sets.back().push_back(message.header.time);
                }) {}
  void push(std::size_t input, const Times& times) {
    for (auto time : times) matcher.push(input, at(time));
  }
};

// The rule as the header of the class has it, tried out over every set there is.

using Range = std::vector<std::pair<std::size_t, std::size_t>>;  // of each input: from, to

void try_all(const std::vector<Times>& inputs, const Range& range, std::vector<std::size_t>& at,
             std::pair<std::int64_t, std::int64_t>& best_key, std::vector<std::size_t>& best) {
  if (at.size() == inputs.size()) {
    Times set;
    for (std::size_t i = 0; i < at.size(); ++i) set.push_back(inputs[i][at[i]]);
    auto [low, high] = std::ranges::minmax(set);
    std::pair key{high - low, low};
    if (best.empty() || key < best_key) {
      best_key = key;
      best = at;
    }
    return;
  }
  auto [from, to] = range[at.size()];
  for (std::size_t i = from; i < to; ++i) {
    at.push_back(i);
    try_all(inputs, range, at, best_key, best);
    at.pop_back();
  }
}

void match(const std::vector<Times>& inputs, const Range& range, std::int64_t within, Sets& sets) {
  std::vector<std::size_t> at, best;
  std::pair<std::int64_t, std::int64_t> key;
  try_all(inputs, range, at, key, best);
  if (best.empty() || key.first > within) return;
  Range before = range, behind = range;
  Times set;
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    before[i].second = best[i];
    behind[i].first = best[i] + 1;
    set.push_back(inputs[i][best[i]]);
  }
  match(inputs, before, within, sets);
  sets.push_back(set);
  match(inputs, behind, within, sets);
}

Sets reference(const std::vector<Times>& inputs, std::int64_t within) {
  Range range;
  for (const auto& times : inputs) range.emplace_back(0, times.size());
  Sets sets;
  match(inputs, range, within, sets);
  return sets;
}

/// Times of inputs that sense the same thing at a rate, with jitter, an offset and drops.
std::vector<Times> random_inputs(std::mt19937& random, std::int64_t grain) {
  auto up_to = [&](std::int64_t most) {
    return std::uniform_int_distribution<std::int64_t>(0, most)(random);
  };
  std::vector<Times> inputs(static_cast<std::size_t>(2 + up_to(2)));
  const std::int64_t period = 10 * grain, jitter = up_to(12) * grain, drops = up_to(4);
  for (auto& times : inputs) {
    const std::int64_t offset = 1 + up_to(period);
    for (std::int64_t i = 0; i < 7; ++i)
      if (up_to(9) >= drops) times.push_back(offset + i * period + up_to(jitter));
    std::ranges::sort(times);
  }
  return inputs;
}

class RandomInputs : public testing::TestWithParam<std::int64_t> {};

// With a grain of 1000 hardly any two differences are equal, with 1 many are.
INSTANTIATE_TEST_SUITE_P(Grains, RandomInputs, testing::Values(1, 1000));

TEST_P(RandomInputs, AreMatchedAsByTryingAllSets) {
  std::mt19937 random(20);
  std::size_t sets = 0;
  for (int round = 0; round < 3000; ++round) {
    const auto inputs = random_inputs(random, GetParam());
    const auto within = std::uniform_int_distribution<std::int64_t>(0, 12 * GetParam())(random);
    Kept kept(inputs.size(), within);
    std::vector<std::size_t> next(inputs.size(), 0), open(inputs.size());
    for (std::size_t i = 0; i < open.size(); ++i) open[i] = i;
    while (!open.empty()) {  // any input is the next, and ends any time after its last
      auto pick = std::uniform_int_distribution<std::size_t>(0, open.size() - 1)(random);
      const std::size_t input = open[pick];
      if (next[input] < inputs[input].size()) {
        kept.push(input, {inputs[input][next[input]++]});
      } else {
        kept.matcher.end(input);
        open.erase(open.begin() + static_cast<std::ptrdiff_t>(pick));
      }
    }
    ASSERT_EQ(kept.sets, reference(inputs, within)) << "round " << round;
    EXPECT_TRUE(kept.matcher.done());
    for (std::size_t i = 0; i < inputs.size(); ++i) {
      EXPECT_EQ(kept.matcher.left_out(i).unmatched + kept.sets.size(), inputs[i].size());
      EXPECT_EQ(kept.matcher.left_out(i).crowded, 0U);
    }
    sets += kept.sets.size();
  }
  EXPECT_GT(sets, 3000U);
}

/// Every way in which an input's times may go on from `latest`, up to a horizon, by two messages.
std::vector<Times> futures(std::int64_t latest, std::int64_t horizon) {
  std::vector<Times> all{{}};
  for (auto a = latest; a <= horizon; ++a) {
    all.push_back({a});
    for (auto b = a; b <= horizon; ++b) all.push_back({a, b});
  }
  return all;
}

TEST(Matcher, GivesASetAsSoonAsNothingThatMayComeCouldChangeIt) {
  std::mt19937 random(21);
  for (int round = 0; round < 100; ++round) {
    std::vector<Times> inputs(2);
    for (auto& times : inputs) {
      for (int i = 0; i < 3; ++i)
        times.push_back(std::uniform_int_distribution<std::int64_t>(1, 12)(random));
      std::ranges::sort(times);
    }
    const auto within = std::uniform_int_distribution<std::int64_t>(0, 6)(random);
    Kept kept(2, within);
    for (std::size_t i = 0; i < 2; ++i) kept.push(i, inputs[i]);
    std::optional<Sets> certain;  // those with which all futures begin
    for (const auto& left : futures(inputs[0].back(), 18))
      for (const auto& right : futures(inputs[1].back(), 18)) {
        auto all = inputs;
        all[0].insert(all[0].end(), left.begin(), left.end());
        all[1].insert(all[1].end(), right.begin(), right.end());
        const Sets sets = reference(all, within);
        if (!certain) certain = sets;
        certain->resize(
            static_cast<std::size_t>(std::ranges::mismatch(*certain, sets).in1 - certain->begin()));
      }
    ASSERT_EQ(kept.sets, *certain) << "round " << round;
  }
}

TEST(Matcher, EqualTimesAreTakenAtOnce) {
  Kept kept(3, 0);
  kept.push(0, {1, 2, 3, 5});
  kept.push(1, {2, 4, 5});
  kept.push(2, {2});
  EXPECT_EQ(kept.sets, (Sets{{2, 2, 2}}));
  kept.push(2, {5});
  EXPECT_EQ(kept.sets, (Sets{{2, 2, 2}, {5, 5, 5}}));
  EXPECT_EQ(kept.matcher.left_out(0).unmatched, 2U);
  EXPECT_EQ(kept.matcher.left_out(1).unmatched, 1U);
}

TEST(Matcher, TheNearestIsWaitedForAndNoLonger) {
  Kept kept(2, 10);
  kept.push(0, {100});
  kept.push(1, {106});
  EXPECT_EQ(kept.sets, Sets{});  // 106 might find something nearer,
  kept.push(0, {112});
  EXPECT_EQ(kept.sets, (Sets{{100, 106}}));  // but no nearer than this
  kept.push(1, {113});
  EXPECT_EQ(kept.sets.size(), 1U);
  kept.push(0, {113});
  EXPECT_EQ(kept.sets, (Sets{{100, 106}, {113, 113}}));
}

TEST(Matcher, WhatIsTooOldForTheLatestOfAnotherInputIsLeftOut) {
  Kept kept(2, 10);
  kept.push(0, {100, 100});
  kept.push(1, {100, 200});
  kept.push(0, {180, 195});
  EXPECT_EQ(kept.matcher.left_out(0).unmatched, 2U);  // 100, 180
  EXPECT_FALSE(kept.matcher.done());
}

TEST(Matcher, WithoutATimeTheOrderDecides) {
  Kept kept(2, 0);
  kept.push(0, {0, 0, 7});
  kept.push(1, {0, 5, 6, 7});
  EXPECT_EQ(kept.sets, (Sets{{0, 0}, {0, 5}, {7, 7}}));
  Kept three(3, 10);
  three.push(0, {0});
  three.push(1, {3, 17});
  three.push(2, {10, 20});
  EXPECT_EQ(three.sets, (Sets{{0, 3, 10}}));
}

TEST(Matcher, TheOldestMakesRoom) {
  Kept kept(2, 0, 3);
  kept.push(0, {1, 2, 3});
  EXPECT_TRUE(kept.matcher.crowded(0));
  kept.push(0, {4, 5});
  EXPECT_FALSE(kept.matcher.crowded(1));
  kept.push(1, {1, 2, 3, 4, 5});
  EXPECT_EQ(kept.sets, (Sets{{3, 3}, {4, 4}, {5, 5}}));
  EXPECT_EQ(kept.matcher.left_out(0).crowded, 2U);
  EXPECT_EQ(kept.matcher.left_out(0).total(), 2U);
  EXPECT_EQ(kept.matcher.left_out(1).unmatched, 2U);
}

TEST(Matcher, LargeMessagesMakeRoomToo) {
  Kept kept(2, 0);
  const std::vector<std::byte> bytes(1);
  for (std::int64_t time : {1, 2}) {
    Message message = at(time);
    message.elements = {bytes.data(), Matcher::kMostWaitingBytes};  // nobody looks at them
    kept.matcher.push(0, message);
  }
  EXPECT_EQ(kept.matcher.left_out(0).crowded, 1U);
}

TEST(Matcher, AfterTheEndOfAnInputTheRestIsLeftOut) {
  Kept kept(2, 5);
  kept.push(0, {10, 20});
  kept.matcher.end(0);
  EXPECT_FALSE(kept.matcher.done());
  kept.push(1, {12, 21});
  EXPECT_EQ(kept.sets, (Sets{{10, 12}, {20, 21}}));
  EXPECT_TRUE(kept.matcher.done());
  kept.push(1, {30, 40});
  EXPECT_EQ(kept.matcher.left_out(1).unmatched, 2U);
}

TEST(Matcher, ATimeThatFallsBeginsAnew) {
  Kept kept(2, 10);
  kept.push(0, {1000, 1100});
  kept.push(1, {1005, 1103});
  EXPECT_EQ(kept.sets, (Sets{{1000, 1005}}));
  kept.push(0, {50});  // the others are settled as they are
  EXPECT_EQ(kept.sets, (Sets{{1000, 1005}, {1100, 1103}}));
  kept.push(1, {50});
  EXPECT_EQ(kept.sets.back(), (Times{50, 50}));
  kept.push(0, {60, 70, 20});
  kept.push(1, {65, 20});  // its writer is late to start anew
  kept.push(0, {150});
  kept.push(1, {150});
  EXPECT_EQ(kept.sets.back(), (Times{150, 150}));
}

TEST(Matcher, AnInputThatHasEndedMayBeginAgain) {
  Kept kept(2, 0);
  kept.push(0, {10});
  kept.matcher.end(1);
  kept.matcher.begin(1);
  EXPECT_FALSE(kept.matcher.done());
  kept.push(0, {20});
  kept.push(1, {20});
  EXPECT_EQ(kept.sets, (Sets{{20, 20}}));
}

TEST(Matcher, ASetWhoseHandlerFailsIsTaken) {
  Matcher matcher(2, {}, [](auto) { throw std::runtime_error("no"); });
  matcher.push(0, at(1));
  EXPECT_THROW(matcher.push(1, at(1)), std::runtime_error);
  matcher.push(1, at(1));
  EXPECT_EQ(matcher.left_out(0).total(), 0U);
}

}  // namespace
}  // namespace hc
