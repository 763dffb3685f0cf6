// SPDX-License-Identifier: Apache-2.0
#include <graph/run/reports.h>

#include <gtest/gtest.h>

#include <hc/mtp/matrix_view.h>
#include <hc/mtp/rows.h>

namespace hc::internal {
namespace {

using namespace std::chrono_literals;

class ReportsTest : public ::testing::Test {
 protected:
  static Message table(std::int32_t src, std::vector<std::vector<std::int64_t>> rows) {
    Draft draft = Draft::make({MatrixType::Table, static_cast<std::uint8_t>(rows[0].size()),
                               Scalar::I64, Encoding::Binary},
                              static_cast<std::int32_t>(rows.size()), 1);
    for (std::size_t i = 0; i < rows.size(); ++i)
      std::copy(rows[i].begin(), rows[i].end(), view<std::int64_t>(draft).row(i).begin());
    draft.header.src = src;
    return std::move(draft).finish();
  }
  static Message rows(std::int32_t src, std::vector<std::string> lines) {
    auto message = make_rows(lines);
    message.header.src = src;
    return message;
  }
  /// Reports counters, 0.5 s after the last ones.
  void count(std::vector<std::vector<std::int64_t>> rows) {
    reports_.take(table(1, std::move(rows)), now_ += 500ms);
  }

  MonotonicTime now_{1s};
  PlannedEnd out_{false, "out", "shm:t.a.out?readers=2&stay=1", ""};
  PlannedEnd in_{true, "in", "unix:@t", ""};
  Reports reports_{{out_, in_}};
};

TEST_F(ReportsTest, RowsOfWhoDoesNotTellAreInputsFirst) {
  EXPECT_EQ(reports_.find(in_), nullptr);
  reports_.take(table(0, {{7, 70}, {9, 90}}), now_);
  ASSERT_NE(reports_.find(in_), nullptr);
  EXPECT_EQ(reports_.find(in_)->traffic.messages, 7U);
  EXPECT_EQ(reports_.find(out_)->traffic.bytes, 90U);
}

TEST_F(ReportsTest, LinksSayTheOrderHoweverManyReaders) {
  EXPECT_TRUE(
      reports_.take(rows(2, {"out out shm:t.a.out?readers=1&stay=1", "in in unix:@t"}), now_));
  reports_.take(table(1, {{9, 90}, {7, 70}}), now_);
  EXPECT_EQ(reports_.find(in_)->traffic.messages, 7U);
  EXPECT_EQ(reports_.find(out_)->traffic.messages, 9U);
}

TEST_F(ReportsTest, EndsThatAreNotReportedAreNotOpen) {
  EXPECT_TRUE(reports_.is_open(out_)) << "unknown";
  reports_.take(rows(2, {"in in unix:@t"}), now_);
  EXPECT_TRUE(reports_.is_open(in_));
  EXPECT_FALSE(reports_.is_open(out_));
}

TEST_F(ReportsTest, RatesAreBetweenTwoReports) {
  count({{0, 0}, {100, 1000}});
  EXPECT_EQ(reports_.find(out_)->per_second, 0);
  count({{0, 0}, {150, 2000}});
  EXPECT_DOUBLE_EQ(reports_.find(out_)->per_second, 100);
  EXPECT_DOUBLE_EQ(reports_.find(out_)->bytes_per_second, 2000);
}

TEST_F(ReportsTest, ReportsThatWaitedTogetherGiveNoRate) {
  count({{0, 0}, {0, 0}});
  count({{0, 0}, {10, 100}});
  for (std::int64_t i = 1; i <= 3; ++i) {
    now_ += std::chrono::microseconds(1);
    reports_.take(table(1, {{0, 0}, {10 + i, 100 + i}}), now_);
    EXPECT_DOUBLE_EQ(reports_.find(out_)->per_second, 20);
    EXPECT_EQ(reports_.find(out_)->traffic.messages, 10U + static_cast<unsigned>(i));
  }
  now_ -= std::chrono::microseconds(3);
  count({{0, 0}, {20, 200}});
  EXPECT_DOUBLE_EQ(reports_.find(out_)->per_second, 20);
}

TEST_F(ReportsTest, RatesFallWhenNothingComes) {
  count({{0, 0}, {0, 0}});
  count({{0, 0}, {10, 100}});
  EXPECT_DOUBLE_EQ(reports_.find(out_)->per_second, 20);
  count({{0, 0}, {10, 100}});
  EXPECT_DOUBLE_EQ(reports_.find(out_)->per_second, 2);
  EXPECT_DOUBLE_EQ(reports_.find(out_)->bytes_per_second, 20);
  for (int i = 0; i < 10; ++i) count({{0, 0}, {10, 100}});
  EXPECT_EQ(reports_.find(out_)->per_second, 0);
}

TEST_F(ReportsTest, WhatASenderDropsHasNoRate) {
  count({{0, 0}, {0, 0}});
  count({{0, 0, 0, 0}, {10, 100, 0, 6}});
  EXPECT_DOUBLE_EQ(reports_.find(out_)->per_second, 8);
  count({{0, 0, 0, 0}, {20, 200, 0, 16}});
  EXPECT_LT(reports_.find(out_)->per_second, 8);
}

TEST_F(ReportsTest, ASlowLinkKeepsItsRateBetweenMessages) {
  count({{0, 0}, {0, 0}});
  for (std::int64_t i = 1; i <= 40; ++i) count({{0, 0}, {i / 4, i}});  // one in 2 s
  EXPECT_DOUBLE_EQ(reports_.find(out_)->per_second, 0.5);
  for (int i = 0; i < 3; ++i) count({{0, 0}, {10, 40}});
  EXPECT_DOUBLE_EQ(reports_.find(out_)->per_second, 0.5);
}

TEST_F(ReportsTest, ALinkThatIsReportedNoMoreHasNoRate) {
  reports_.take(rows(2, {"out out shm:t.a.out", "in in unix:@t"}), now_);
  count({{0, 0}, {0, 0}});
  count({{0, 0}, {10, 100}});
  EXPECT_GT(reports_.find(in_)->per_second, 0);
  count({{0, 0}});
  EXPECT_EQ(reports_.find(in_)->per_second, 0);
}

TEST_F(ReportsTest, CountsGoOnWhenItIsStartedAnew) {
  count({{1, 1}, {100, 1000}});
  reports_.end();
  EXPECT_EQ(reports_.find(out_)->traffic.messages, 100U);
  count({{2, 2}, {200, 2000}});
  EXPECT_EQ(reports_.find(out_)->traffic.messages, 300U);
  EXPECT_EQ(reports_.find(out_)->per_second, 0);
  count({{2, 2}, {50, 500}});  // a reopened link counts from 0
  EXPECT_EQ(reports_.find(out_)->traffic.messages, 350U);
}

TEST_F(ReportsTest, CountsGoOnWhenALinkGetsAnotherPolicy) {
  reports_.take(rows(2, {"in in unix:@t", "out out shm:t.a.out?readers=2&stay=1"}), now_);
  count({{1, 1}, {100, 1000}});
  PlannedEnd other{false, "out", "shm:t.a.out?readers=2&stay=1&rate=5", ""};
  reports_.set_ends({other, in_});
  EXPECT_EQ(reports_.find(other)->traffic.messages, 100U);
  count({{1, 1}, {110, 1100}});  // at its removal
  reports_.take(rows(2, {"in in unix:@t"}), now_);
  count({{2, 2}});
  reports_.take(rows(2, {"in in unix:@t", "out out shm:t.a.out?readers=2&stay=1&rate=5"}), now_);
  count({{3, 3}, {200, 2000}});  // the new link has already counted more
  EXPECT_EQ(reports_.find(in_)->traffic.messages, 3U);
  EXPECT_EQ(reports_.find(other)->traffic.messages, 310U);
}

TEST_F(ReportsTest, RowsOfOneLinkAddUp) {
  reports_.take(rows(2, {"in in unix:@t", "in in unix:@t", "out out shm:t.a.out"}), now_);
  for (int i = 0; i < 3; ++i)
    count({{5, 50, 0, 0, 0, 0, 0, 2}, {3, 30, 0, 0, 0, 0, 0, 1}, {7, 70, 0, 0, 0, 0, 0, 0}});
  EXPECT_EQ(reports_.find(in_)->traffic.messages, 8U);
  EXPECT_EQ(reports_.find(in_)->ignored, 3U);
  EXPECT_EQ(reports_.find(in_)->per_second, 0);
  EXPECT_EQ(reports_.find(out_)->traffic.messages, 7U);
}

TEST_F(ReportsTest, LinksThatThePlanDoesNotKnowAreForgotten) {
  count({{1, 1}, {100, 1000}});
  reports_.set_ends({in_});
  EXPECT_EQ(reports_.find(out_), nullptr);
  EXPECT_EQ(reports_.find(in_)->traffic.messages, 1U);
  reports_.take(rows(2, {"in in unix:@t", "out out shm:t.a.out"}), now_);
  count({{2, 2}, {110, 1100}});
  EXPECT_EQ(reports_.find(out_), nullptr);
  reports_.set_ends({in_, out_});
  count({{2, 2}, {10, 100}});
  EXPECT_EQ(reports_.find(out_)->traffic.messages, 10U);
}

TEST_F(ReportsTest, AllColumnsAreTaken) {
  count({{1, 2, 3, 4, 5, 6, 7, 8, 10, 11, 12, 20, 21, 22}});
  const auto* report = reports_.find(in_);
  EXPECT_EQ(report->traffic.dropped_disconnect, 7U);
  EXPECT_EQ(report->ignored, 8U);
  EXPECT_EQ(report->age, (std::array<std::int64_t, 3>{10, 11, 12}));
  EXPECT_EQ(report->gap, (std::array<std::int64_t, 3>{20, 21, 22}));
}

TEST_F(ReportsTest, ParametersAndModeTellOfChangesAlone) {
  auto parameters = rows(3, {"rate=30", "text=a = b"});
  EXPECT_TRUE(reports_.take(parameters, now_));
  EXPECT_FALSE(reports_.take(parameters, now_));
  EXPECT_EQ(reports_.parameters().at("text"), "a = b");
  EXPECT_TRUE(reports_.take(table(4, {{2, 1, 0}}), now_));
  EXPECT_FALSE(reports_.take(table(4, {{2, 1, 0}}), now_));
  EXPECT_EQ(reports_.state().blocked_row, 0);
  EXPECT_FALSE(reports_.take(table(4, {{2, 1, 0, 2}}), now_));  // not a change
  EXPECT_EQ(reports_.state().blocked_row, 2);
  EXPECT_EQ(reports_.blocked_output(), "out");
  EXPECT_EQ(reports_.state().mode, 2);
  EXPECT_EQ(reports_.state().focus, 1);
  EXPECT_FALSE(reports_.state().in_focus);
}

TEST_F(ReportsTest, OfTooManyTheFirstAreKept) {
  std::vector<std::string> links, parameters;
  std::vector<std::vector<std::int64_t>> counters;
  std::vector<PlannedEnd> ends;
  const auto uri = [](std::size_t i) { return "unix:@" + std::to_string(i); };
  for (std::size_t i = 0; i <= Reports::kMostEnds; ++i) {
    ends.push_back({true, "in", uri(i), ""});
    links.push_back("in in " + uri(i));
    counters.push_back({1, 1});
  }
  for (std::size_t i = 0; i <= Reports::kMostParameters; ++i)
    parameters.push_back(std::to_string(i) + "=");
  reports_.set_ends(ends);
  reports_.take(rows(2, links), now_);
  count(counters);
  auto messages = [&](std::size_t i) {
    const auto* report = reports_.find(ends[i]);
    return report == nullptr ? 0 : report->traffic.messages;
  };
  EXPECT_EQ(messages(Reports::kMostEnds - 1), 1U);
  EXPECT_EQ(messages(Reports::kMostEnds), 0U);
  reports_.take(rows(3, parameters), now_);
  EXPECT_EQ(reports_.parameters().size(), Reports::kMostParameters);
}

TEST_F(ReportsTest, WhatMakesNoSenseIsPassedOver) {
  reports_.take(rows(2, {"", "in", "out x"}), now_);
  EXPECT_FALSE(reports_.take(rows(1, {"no table"}), now_));
  EXPECT_FALSE(reports_.take(table(4, {{1, 2}}), now_));
  EXPECT_FALSE(reports_.take(table(1, {{1}}), now_));
}

}  // namespace
}  // namespace hc::internal
