// SPDX-License-Identifier: Apache-2.0
#include "announcer.h"

#include <gtest/gtest.h>

namespace {

using namespace std::chrono_literals;

TEST(Announcer, says_what_most_of_the_last_readings_are) {
  Announcer announcer;
  const Announcer::Rules rules{0.5, 3, 0};
  EXPECT_FALSE(announcer.take("A", 0.9, hc::unix_time(1), rules));
  EXPECT_FALSE(announcer.take("B", 0.9, hc::unix_time(2), rules));
  EXPECT_FALSE(announcer.take("A", 0.9, hc::unix_time(3), rules));
  EXPECT_FALSE(announcer.take("C", 0.9, hc::unix_time(4), rules));
  EXPECT_TRUE(announcer.take("A", 0.9, hc::unix_time(5), rules));
  EXPECT_FALSE(announcer.take("A", 0.9, hc::unix_time(6), rules)) << "it was said";
}

TEST(Announcer, what_flickers_is_not_said_instead) {
  Announcer announcer;
  const Announcer::Rules rules{0.5, 2, 0};
  for (const char* text : {"A", "A", "B", "B"}) announcer.take(text, 0.9, hc::unix_time(1), rules);
  EXPECT_FALSE(announcer.take("A", 0.9, hc::unix_time(2), rules));
  EXPECT_FALSE(announcer.take("B", 0.9, hc::unix_time(3), rules));
}

TEST(Announcer, a_letter_that_is_read_so_or_so_is_not_said_both_ways) {
  Announcer announcer;
  const Announcer::Rules rules{0.5, 2, 0};
  EXPECT_FALSE(announcer.take("DW9S 2DK", 0.9, hc::unix_time(1), rules));
  EXPECT_TRUE(announcer.take("DW9S 2DK", 0.9, hc::unix_time(2), rules));
  for (int i = 0; i < 5; ++i)
    EXPECT_FALSE(announcer.take("DWIYS 2DK", 0.9, hc::unix_time(3), rules));
  EXPECT_TRUE(announcer.take("DWIYS 2DK", 0.9, hc::unix_time(4), rules)) << "it stays so";
  EXPECT_FALSE(announcer.take("HELLO", 0.9, hc::unix_time(5), rules));
  EXPECT_TRUE(announcer.take("HELLO", 0.9, hc::unix_time(6), rules)) << "another text";
}

TEST(Announcer, an_unsure_reading_does_not_count) {
  Announcer announcer;
  const Announcer::Rules rules{0.5, 2, 0};
  EXPECT_FALSE(announcer.take("A", 0.9, hc::unix_time(1), rules));
  EXPECT_FALSE(announcer.take("A", 0.4, hc::unix_time(2), rules));
  EXPECT_TRUE(announcer.take("A", 0.5, hc::unix_time(3), rules));
}

TEST(Announcer, nothing_is_never_said) {
  Announcer announcer;
  EXPECT_FALSE(announcer.take("", 1, hc::unix_time(1), {0, 1, 0}));
}

TEST(Announcer, says_it_again_when_it_changes_or_after_a_while) {
  Announcer announcer;
  const Announcer::Rules rules{0, 1, 10};
  EXPECT_TRUE(announcer.take("A", 1, hc::Time(1s), rules));
  EXPECT_FALSE(announcer.take("A", 1, hc::Time(10s), rules));
  EXPECT_TRUE(announcer.take("A", 1, hc::Time(11s), rules));
  EXPECT_TRUE(announcer.take("B", 1, hc::Time(12s), rules));
  EXPECT_TRUE(announcer.take("A", 1, hc::Time(13s), rules));
}

TEST(Announcer, never_again_with_0) {
  Announcer announcer;
  EXPECT_TRUE(announcer.take("A", 1, hc::unix_time(1), {0, 1, 0}));
  EXPECT_FALSE(announcer.take("A", 1, hc::Time(1'000'000s), {0, 1, 0}));
}

TEST(Announcer, a_clock_that_went_back_does_not_silence_it) {
  Announcer announcer;
  EXPECT_TRUE(announcer.take("A", 1, hc::Time(100s), {0, 1, 10}));
  EXPECT_TRUE(announcer.take("A", 1, hc::Time(5s), {0, 1, 10}));
}

TEST(Announcer, sums_up_what_it_said) {
  Announcer announcer;
  const Announcer::Rules rules{0.5, 1, 0};
  announcer.take("A", 0.4, hc::unix_time(1), rules);
  EXPECT_EQ(announcer.summary(), "");
  announcer.take("A", 1, hc::unix_time(2), rules);
  EXPECT_EQ(announcer.summary(), "read 1 text, the last \"A\"");
  announcer.take("B", 1, hc::unix_time(3), rules);
  announcer.take("B", 1, hc::unix_time(4), rules);
  EXPECT_EQ(announcer.summary(), "read 2 texts, the last \"B\"");
}

TEST(Announcer, repeats_what_was_not_heard_when_it_is_heard) {
  Announcer announcer;
  const Announcer::Rules rules{0, 1, 10};
  EXPECT_TRUE(announcer.take("A", 1, hc::Time(1s), rules, false));
  EXPECT_FALSE(announcer.take("A", 1, hc::Time(2s), rules, false));
  EXPECT_TRUE(announcer.take("A", 1, hc::Time(3s), rules, true));
  EXPECT_FALSE(announcer.take("A", 1, hc::Time(4s), rules, true));
  // It was spoken before the focus was lost and regained.
  EXPECT_FALSE(announcer.take("A", 1, hc::Time(5s), rules, false));
  EXPECT_FALSE(announcer.take("A", 1, hc::Time(6s), rules, true));
}

}  // namespace
