// SPDX-License-Identifier: Apache-2.0
#include <hc/contract/report.h>

#include <gtest/gtest.h>

#include <hc/mtp/matrix_view.h>
#include <hc/mtp/rows.h>

namespace hc {
namespace {

TEST(Report, CountersComeBackAsTheyWere) {
  LinkCounters link{{1, 2, 3, 4, 5, 6, 7}, 8, {10, 11, 12}, {20, 21, 22}};
  const auto message = make_counters(std::array{link, LinkCounters{}});
  EXPECT_EQ(message.header.info.components, kCounterColumns.size());
  const auto numbers = view<std::int64_t>(message)->numbers();
  EXPECT_EQ(std::vector<std::int64_t>(numbers.begin(), numbers.begin() + 14),
            (std::vector<std::int64_t>{1, 2, 3, 4, 5, 6, 7, 8, 10, 11, 12, 20, 21, 22}));
  const auto rows = read_counters(message);
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(rows[0].traffic.dropped_disconnect, 7U);
  EXPECT_EQ(rows[0].ignored, 8U);
  EXPECT_EQ(rows[0].age, link.age);
  EXPECT_EQ(rows[0].gap, link.gap);
  EXPECT_EQ(rows[1].age, (Durations{-1, -1, -1}));
  EXPECT_TRUE(read_counters(make_counters({})).empty());
}

TEST(Report, TheFirstTwoColumnsAreEnough) {
  Draft draft = Draft::make({MatrixType::Table, 2, Scalar::I64, Encoding::Text}, 1, 1);
  view<std::int64_t>(draft).numbers()[0] = 5;
  view<std::int64_t>(draft).numbers()[1] = 50;
  const auto rows = read_counters(std::move(draft).finish());
  ASSERT_EQ(rows.size(), 1U);
  EXPECT_EQ(rows[0].traffic.bytes, 50U);
  EXPECT_EQ(rows[0].gap, (Durations{-1, -1, -1}));
}

TEST(Report, LinksParametersAndStateComeBack) {
  const auto links = read_links(
      make_links(std::array{LinkEnd{true, "left", "unix:@a"}, LinkEnd{false, "out", "shm:b"}}));
  ASSERT_EQ(links.size(), 2U);
  EXPECT_TRUE(links[0].is_input);
  EXPECT_EQ(links[1].port, "out");
  EXPECT_EQ(links[1].uri, "shm:b");
  const std::map<std::string, std::string> values = {{"rate", "30"}, {"text", "a = b"}};
  EXPECT_EQ(read_parameters(make_parameters(values), 9), values);
  EXPECT_EQ(read_parameters(make_parameters(values), 1).size(), 1U);
  const StateReport state{3, 2, false, 4, {{12, true}, {14, false}}};
  EXPECT_EQ(read_state(make_state(state)), state);
}

TEST(Report, WhatMakesNoSenseIsIgnored) {
  const auto text = make_rows(std::vector<std::string>{"", "in", "out x"});
  EXPECT_TRUE(read_links(text).empty());
  EXPECT_TRUE(read_counters(text).empty());
  EXPECT_FALSE(read_state(text));
  EXPECT_TRUE(read_links(make_state({})).empty());
}

}  // namespace
}  // namespace hc
