// SPDX-License-Identifier: Apache-2.0
#include "read_score.h"

#include <algorithm>
#include <chrono>
#include <set>

#include <gtest/gtest.h>

namespace {

hc::Time after(std::int64_t milliseconds) {
  return hc::Time(std::chrono::milliseconds(milliseconds));
}

TEST(RandomText, is_a_word_or_two_of_letters_and_digits) {
  std::mt19937_64 random(7);
  std::set<std::size_t> lengths;
  for (int i = 0; i < 2000; ++i) {
    const auto text = random_text(random);
    lengths.insert(text.size());
    const auto space = text.find(' ');
    EXPECT_EQ(space == text.npos, text.size() <= 8) << text;
    EXPECT_EQ(text.find(' ', space == text.npos ? space : space + 1), text.npos) << text;
    const auto first = std::min(space, text.size());
    EXPECT_TRUE(first >= 3 && first <= 8) << text;
    if (space != text.npos) {
      EXPECT_TRUE(text.size() - space - 1 >= 3 && text.size() - space - 1 <= 8) << text;
    }
    for (const char letter : text)
      EXPECT_TRUE((letter >= 'A' && letter <= 'Z') || (letter >= '0' && letter <= '9') ||
                  letter == ' ');
  }
  EXPECT_EQ(lengths.size(), 12);
  EXPECT_EQ(*lengths.begin(), 5);
}

TEST(RandomText, a_seed_gives_the_same_again) {
  std::mt19937_64 random(7), again(7), other(8);
  const auto text = random_text(random);
  EXPECT_EQ(text, random_text(again));
  EXPECT_NE(text, random_text(other));
}

TEST(Edits, are_the_fewest) {
  EXPECT_EQ(edits("", ""), 0);
  EXPECT_EQ(edits("ROBOT", "ROBOT"), 0);
  EXPECT_EQ(edits("ROBOT", ""), 5);
  EXPECT_EQ(edits("", "ROBOT"), 5);
  EXPECT_EQ(edits("R0BOT", "ROBOT"), 1);
  EXPECT_EQ(edits("ROBOT", "RBOT"), 1);
  EXPECT_EQ(edits("ROBOT", "RO BOT"), 1);
  EXPECT_EQ(edits("KITTEN", "SITTING"), 3);
}

TEST(Attempt, is_done_when_read_and_spoken_in_any_order) {
  for (const bool is_sound_first : {false, true}) {
    Attempt attempt("ABC", after(1000));
    if (is_sound_first) attempt.take_sound(after(1100), after(1300));
    EXPECT_FALSE(attempt.is_done());
    attempt.take_text("ABD", after(1100));
    if (!is_sound_first) {
      EXPECT_FALSE(attempt.is_done());
      attempt.take_sound(after(1100), after(1300));
    }
    EXPECT_TRUE(attempt.is_done());
    const auto result = attempt.result();
    EXPECT_EQ(result.truth, "ABC");
    EXPECT_EQ(result.read, "ABD");
    ASSERT_TRUE(result.seen_to_spoken);
    EXPECT_NEAR(*result.seen_to_spoken, 0.3, 1e-9);
    EXPECT_NEAR(result.work, 0.2, 1e-9);
  }
}

TEST(Attempt, what_was_seen_before_does_not_count) {
  Attempt attempt("ABC", after(1000));
  attempt.take_text("OLD", after(999));
  attempt.take_sound(after(999), after(1300));
  EXPECT_EQ(attempt.result().read, "");
  EXPECT_FALSE(attempt.result().seen_to_spoken);
}

TEST(Attempt, the_first_reading_counts) {
  Attempt attempt("ABC", after(0));
  attempt.take_text("AC", hc::unix_time(1));
  attempt.take_text("ABC", hc::unix_time(2));
  attempt.take_sound(hc::unix_time(1), after(10));
  attempt.take_sound(hc::unix_time(2), after(20));
  EXPECT_EQ(attempt.result().read, "AC");
  EXPECT_NEAR(*attempt.result().seen_to_spoken, 0.01, 1e-9);
}

TEST(ReadingScore, is_over_all_letters_and_all_that_were_spoken) {
  const auto score = score_of({{"ABCDE", "ABXDE", 0.5, 0.1},
                               {"FGHIJ", "", {}},
                               {"KLMNOPQRST", "KLMNOPQRST", 0.3, 0.2},
                               {"UVWXY", "UVWXYZ", 0.9, 0.6}});
  EXPECT_NEAR(score.error_rate, 7.0 / 25, 1e-12);
  EXPECT_EQ(score.median, 0.5);
  EXPECT_EQ(score.most, 0.9);
  EXPECT_EQ(score.work, 0.2);
  EXPECT_EQ(score.texts, 4);
  EXPECT_EQ(score.unspoken, 1);
  EXPECT_NEAR(score_of({{"A", "A", 0.5, 0}, {"B", "B", 0.4, 0}}).median, 0.45, 1e-12);
  EXPECT_EQ(score_of({}).error_rate, 0);
  EXPECT_EQ(score.numbers(), (std::array<double, 6>{score.error_rate, 0.5, 0.9, 0.2, 4, 1}));
  EXPECT_EQ(score.text(),
            "character error rate 28.0 %, seen to spoken 0.50 s median, 0.90 s at most, of 4 "
            "texts; 1 not spoken in time");
}

TEST(Dictation, writes_the_next_text_after_the_speech_and_a_pause) {
  Dictation dictation(7, after(10'000));
  const auto write = [&](std::int64_t ms) { return dictation.write(after(ms)); };
  const auto finish = [&](std::int64_t ms) { return dictation.finish(after(ms), 10, 0.3); };
  EXPECT_FALSE(write(9'999));
  const auto first = write(10'000);
  ASSERT_TRUE(first);
  EXPECT_FALSE(write(10'010)) << "one at a time";
  dictation.take_text(*first, after(10'100), after(10'200));
  EXPECT_FALSE(finish(10'300));
  dictation.take_sound(after(10'100), after(10'400), 2);
  const auto ended = finish(10'400);
  ASSERT_TRUE(ended);
  EXPECT_EQ(ended->read, *first);
  EXPECT_FALSE(finish(10'410));
  EXPECT_FALSE(write(12'699)) << "it is spoken until 12.4 s";
  EXPECT_TRUE(write(12'700));
}

TEST(Dictation, begins_soon_after_something_is_read) {
  Dictation dictation(7, after(10'000));
  dictation.take_text("WHAT STOOD THERE", after(0), after(2'000));
  dictation.take_text("WHAT STOOD THERE", after(0), after(2'500));
  EXPECT_FALSE(dictation.write(after(2'999)));
  EXPECT_TRUE(dictation.write(after(3'000))) << "after the first, not the second";
}

TEST(Dictation, a_text_that_is_not_read_in_time_ends) {
  Dictation dictation(7, after(0));
  ASSERT_TRUE(dictation.write(after(0)));
  EXPECT_FALSE(dictation.is_done(0)) << "one is not ended";
  EXPECT_FALSE(dictation.finish(after(4'999), 5, 0));
  const auto ended = dictation.finish(after(5'000), 5, 0);
  ASSERT_TRUE(ended);
  EXPECT_EQ(ended->read, "");
  EXPECT_TRUE(dictation.is_done(1));
  EXPECT_FALSE(dictation.is_done(2));
  EXPECT_EQ(dictation.score().unspoken, 1);
}

}  // namespace
