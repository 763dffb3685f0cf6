// SPDX-License-Identifier: Apache-2.0
#include "stop.h"

#include <vector>

#include <gtest/gtest.h>

namespace {

using std::chrono::milliseconds;
using Word = Stop::Word;

/// A stop, its clock and its answers.
struct Page {
  Stop stop{"web"};
  hc::MonotonicTime now{milliseconds(1000)};
  std::vector<std::string> answers;

  Word order(bool stops, bool is_linked = true) {
    return stop.order(stops, is_linked, now,
                      [this](const std::string& problem) { answers.push_back(problem); });
  }
  /// A page is open for a while.
  void open() {
    while (!tick()) continue;
  }
  std::optional<Word> tick(std::optional<bool> is_guarded = true,
                           milliseconds later = Stop::kPeriod) {
    now += later;
    return stop.tick(is_guarded, now);
  }
};

TEST(Stop, is_answered_when_the_workspace_says_so_after_the_order) {
  Page page;
  page.stop.hear(true, page.now);  // earlier, by another source
  EXPECT_EQ(page.order(true), Word::Stop);
  EXPECT_TRUE(page.answers.empty());
  page.stop.hear(false, page.now);
  EXPECT_TRUE(page.answers.empty());
  page.stop.hear(true, page.now);
  EXPECT_EQ(page.answers, std::vector<std::string>{""});
  EXPECT_EQ(page.stop.is_stopped(page.now), true);
}

TEST(Stop, is_repeated_until_it_is_cleared_whoever_watches) {
  Page page;
  page.open();
  page.order(true);
  for (const bool is_guarded : {true, false, true}) EXPECT_EQ(page.tick(is_guarded), Word::Stop);
  page.stop.hear(true, page.now);
  EXPECT_EQ(page.order(false), Word::Clear);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(page.tick(), Word::Clear) << "it may not have arrived";
  page.stop.hear(false, page.now);
  EXPECT_EQ(page.tick(), Word::Free);
  EXPECT_EQ(page.answers, (std::vector<std::string>{"", ""}));
}

TEST(Stop, says_that_the_workspace_has_not_confirmed_it) {
  Page page;
  page.order(true);
  page.tick(true, milliseconds(499));
  EXPECT_TRUE(page.answers.empty());
  EXPECT_EQ(page.tick(true, milliseconds(1)), Word::Stop);
  ASSERT_EQ(page.answers.size(), 1U);
  EXPECT_EQ(page.answers[0],
            "stop NOT confirmed: nothing comes to web.stopped; link it to the workspace's output");
  page.stop.hear(false, page.now);  // just before the order
  page.order(true);
  page.tick(true, milliseconds(500));
  EXPECT_EQ(page.answers.at(1), "stop NOT confirmed: the workspace does not answer");
  EXPECT_EQ(page.stop.is_stopped(page.now), false);
  page.order(true);
  page.tick(true, milliseconds(499));
  page.stop.hear(false, page.now);
  page.tick(true, milliseconds(1));
  EXPECT_EQ(page.answers.at(2),
            "stop NOT confirmed: the workspace says that the robot is not stopped");
  page.now += milliseconds(1000);
  EXPECT_EQ(page.stop.is_stopped(page.now), std::nullopt);
  page.stop.hear(true, page.now);
  page.order(false);
  page.stop.hear(true, page.now + milliseconds(400));
  page.tick(true, milliseconds(500));
  EXPECT_EQ(page.answers.at(3), "NOT cleared: the workspace says that the robot is still stopped");
  page.order(true, false);
  EXPECT_TRUE(page.answers.at(4).starts_with("stop NOT confirmed: nothing is linked to web.stop"));
}

TEST(Stop, of_two_orders_the_later_counts) {
  Page page;
  page.order(false);
  page.order(true);
  EXPECT_EQ(page.answers, std::vector<std::string>{"NOT cleared: it was stopped again meanwhile"});
  EXPECT_EQ(page.tick(), Word::Stop);
  page.order(true);
  page.stop.hear(true, page.now);
  EXPECT_EQ(page.answers.size(), 3U);
  page.order(true);
  page.order(false);
  EXPECT_EQ(page.answers.at(3), "stop NOT confirmed: it was cleared meanwhile");
}

TEST(Stop, that_a_page_has_kept_comes_before_its_guard) {
  Page page;
  for (auto passed = milliseconds(0); passed < Stop::kFirst; passed += Stop::kPeriod)
    EXPECT_EQ(page.tick(), std::nullopt);
  EXPECT_EQ(page.tick(), Word::Free);
  Page closed;
  EXPECT_EQ(closed.tick(), std::nullopt);
  EXPECT_EQ(closed.tick(false), std::nullopt) << "one that guarded nothing does not leave";
  Page again;
  EXPECT_EQ(again.tick(), std::nullopt);
  EXPECT_EQ(again.order(true), Word::Stop);
  EXPECT_EQ(again.tick(), Word::Stop);
}

TEST(Stop, of_another_source_is_not_taken_over) {
  Page page;
  page.open();  // the workspace remembers the stops of the previous process and of other sources
  page.stop.hear(true, page.now);
  EXPECT_EQ(page.tick(), Word::Free);
}

TEST(Stop, says_nothing_for_a_process_before_it_whose_page_may_have_wanted_a_stop) {
  Page page;
  for (int i = 0; i < 3; ++i) EXPECT_EQ(page.tick(false), std::nullopt);
}

TEST(Stop, guards_nobody_while_pages_cannot_be_heard) {
  Page page;
  page.open();
  EXPECT_EQ(page.tick(), Word::Free);
  for (int i = 0; i < 9; ++i) EXPECT_EQ(page.tick(std::nullopt), std::nullopt);
  EXPECT_EQ(page.tick(), Word::Free);
  page.order(true);
  EXPECT_EQ(page.tick(std::nullopt), Word::Stop);
}

TEST(Stop, is_cleared_once_where_nothing_can_confirm_it) {
  Page page;
  page.open();
  page.order(true);
  EXPECT_EQ(page.order(false), Word::Clear);
  EXPECT_EQ(page.tick(), std::nullopt);
  EXPECT_EQ(page.tick(), Word::Free);
}

TEST(Stop, says_three_times_that_the_last_page_has_gone) {
  Page page;
  page.open();
  EXPECT_EQ(page.tick(), Word::Free);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(page.tick(false), Word::Unguarded);
  EXPECT_EQ(page.tick(false), std::nullopt);
  EXPECT_EQ(page.tick(), Word::Free);
  page.order(true);
  EXPECT_EQ(page.tick(false), Word::Stop);
}

}  // namespace
