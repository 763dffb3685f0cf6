// SPDX-License-Identifier: Apache-2.0
// Dialogues from the manual (PTU-D46 Command Reference 2.14).
#include <drivers/pan_tilt/unit.h>

#include <gtest/gtest.h>

namespace hc::pan_tilt {
namespace {

/// A unit in terse mode without echo, as drivers use it.
Unit quiet_unit(double pan = 0, double tilt = 0) {
  Unit unit(pan, tilt);
  unit.take(0, "ft ed ci ");
  return unit;
}

TEST(Unit, begins_with_echo_and_verbose) {
  Unit unit(22);
  EXPECT_EQ(unit.take(0, "PP "), "PP * Current Pan position is 22\r\n");
  EXPECT_EQ(unit.take(0, "PP3200 "), "PP3200 ! Maximum allowable Pan position is 3090\r\n");
  EXPECT_EQ(unit.take(0, "FT "), "FT *\r\n");
  EXPECT_EQ(unit.take(0, "PP "), "PP * 22\r\n");
  EXPECT_EQ(unit.take(0, "ED "), "ED *\r\n");
  EXPECT_EQ(unit.take(0, "pp "), "* 22\r\n");
  EXPECT_EQ(unit.take(0, "e fv e "), "* OFF\r\n*\r\n* Echoing is OFF\r\n");
  EXPECT_EQ(unit.take(0, "ee f "), "*\r\nf * ASCII verbose mode\r\n");
}

TEST(Unit, commands_may_come_byte_by_byte_and_end_in_space_or_return) {
  Unit unit = quiet_unit();
  std::string said;
  for (char byte : std::string("  Pp100\rtp-20\r\nPo \n")) said += unit.take(0, {&byte, 1});
  EXPECT_EQ(said, "*\r\n*\r\n* 100\r\n");
}

TEST(Unit, reports_resolution_limits_and_pace) {
  Unit unit = quiet_unit();
  EXPECT_EQ(unit.take(0, "pr tr pn px tn tx "),
            "* 185.1428\r\n* 185.1428\r\n* -3090\r\n* 3090\r\n* -907\r\n* 604\r\n");
  EXPECT_EQ(unit.take(0, "ps ts pa ta pb tb pu tu pl tl "),
            "* 1000\r\n* 1000\r\n* 2000\r\n* 2000\r\n* 1000\r\n* 1000\r\n* 2902\r\n* 2902\r\n"
            "* 31\r\n* 31\r\n");
  EXPECT_EQ(unit.take(0, "fv pr l c "),
            "*\r\n* 185.1428 seconds arc per position\r\n* Limit bounds are ENABLED\r\n"
            "* PTU is in Independent Mode\r\n");
}

TEST(Unit, turns_where_it_is_sent) {
  Unit unit = quiet_unit();
  EXPECT_EQ(unit.take(0, "pp500 tp-200 "), "*\r\n*\r\n");
  EXPECT_EQ(unit.take(0.1, "pp tp po to pd "), "* 100\r\n* -100\r\n* 500\r\n* -200\r\n* 1000\r\n");
  EXPECT_EQ(unit.take(1, "pp tp pd po100 "), "* 500\r\n* -200\r\n* 0\r\n*\r\n");
  EXPECT_EQ(unit.take(2, "pp "), "* 600\r\n");
  EXPECT_EQ(unit.take(2, "ps2000 pa4000 pb500 ps "), "*\r\n*\r\n*\r\n* 2000\r\n");
  EXPECT_EQ(unit.take(2, "po-1000 "), "*\r\n");
  EXPECT_NEAR(unit.pan(2.1), 600 - (500 * 0.1 + 4000 * 0.01 / 2), 1e-6);
}

TEST(Unit, refuses_what_is_beyond_its_limits) {
  Unit unit = quiet_unit();
  EXPECT_EQ(unit.take(0, "pp-3091 "), "! Minimum allowable Pan position is -3090\r\n");
  EXPECT_EQ(unit.take(0, "tp605 "), "! Maximum allowable Tilt position is 604\r\n");
  EXPECT_EQ(unit.take(0, "to-908 "), "! Minimum allowable Tilt position is -907\r\n");
  EXPECT_EQ(unit.take(0, "ps2903 "), "! Pan speed cannot exceed 2902 positions/sec\r\n");
  EXPECT_EQ(unit.take(0, "pu600 ps700 "), "*\r\n! Pan speed cannot exceed 600 positions/sec\r\n");
  EXPECT_EQ(unit.take(0, "ts30 "), "! Tilt speed cannot be below 31 positions/sec\r\n");
  EXPECT_EQ(unit.take(0, "pp tp "), "* 0\r\n* 0\r\n");
}

TEST(Unit, refuses_what_is_no_command) {
  Unit unit = quiet_unit();
  for (const char* words : {"x ", "ppx ", "pp1x ", "pp- ", "pp99999999999 ", "pr5 ", "p ", "* "})
    EXPECT_EQ(unit.take(0, words), "! Illegal command entered\r\n") << words;
}

TEST(Unit, a_word_that_is_too_long_is_dropped_and_the_next_one_is_obeyed) {
  Unit unit = quiet_unit();
  for (std::size_t size : {255U, 256U, 257U, 1000U}) {
    unit.take(0, std::string(size, 'x'));
    unit.take(0, " ");
    EXPECT_EQ(unit.take(0, "pp "), "* 0\r\n") << size;
  }
}

TEST(Unit, of_what_waits_only_whole_words_are_lost) {
  Unit unit = quiet_unit();
  std::string words = "pp500 a ";
  for (int i = 0; i < 100; ++i) words += "tp-100 ";
  EXPECT_EQ(unit.take(0, words), "*\r\n");  // 7 bytes each: the buffer ends within one
  std::string said;
  for (int i = 0; i < 1 + 256 / 7; ++i) said += "*\r\n";
  EXPECT_EQ(unit.pass(0.5), said);
  EXPECT_EQ(unit.take(1, "pp tp "), "* 500\r\n* -100\r\n");
}

TEST(Unit, awaits_the_end_of_a_motion) {
  Unit unit = quiet_unit();
  EXPECT_EQ(unit.take(0, "pp500 a pp "), "*\r\n");
  EXPECT_EQ(unit.pass(0.4), "");
  EXPECT_EQ(*unit.next(), 0.5);
  EXPECT_EQ(unit.pass(0.5), "*\r\n* 500\r\n");
  EXPECT_EQ(unit.take(0.6, "a "), "*\r\n");
  EXPECT_FALSE(unit.next());
}

TEST(Unit, halts) {
  Unit unit = quiet_unit();
  unit.take(0, "pp500 tp500 ");
  EXPECT_EQ(unit.take(0.1, "hp "), "*\r\n");
  EXPECT_EQ(unit.take(0.2, "pp tp h "), "* 100\r\n* 200\r\n*\r\n");
  EXPECT_EQ(unit.take(1, "pp tp "), "* 100\r\n* 200\r\n");
}

TEST(Unit, runs_into_its_limit_when_limits_are_off_and_says_so) {
  Unit unit = quiet_unit(0, 500);
  EXPECT_EQ(unit.take(0, "ld tp5000 "), "*\r\n*\r\n");
  EXPECT_EQ(unit.pass(0.103), "");
  EXPECT_EQ(unit.pass(0.104), "!T");
  EXPECT_EQ(unit.take(1, "tp l "), "* 604\r\n* DISABLED\r\n");
}

TEST(Unit, turns_with_a_speed_until_its_limit) {
  Unit unit = quiet_unit();
  EXPECT_EQ(unit.take(0, "cv ps-1000 "), "*\r\n*\r\n");
  EXPECT_EQ(unit.take(1, "pp ps0 "), "* -1000\r\n*\r\n");
  EXPECT_EQ(unit.take(2, "pp ps500 "), "* -1000\r\n*\r\n");
  EXPECT_EQ(unit.pass(20), "!P");
  EXPECT_EQ(unit.take(20, "pp pd c "), "* 3090\r\n* 0\r\n* Pure Velocity Mode\r\n");
}

TEST(Unit, resets) {
  Unit unit = quiet_unit(1000, -500);
  EXPECT_EQ(unit.take(0, "r pp "), "");
  EXPECT_EQ(unit.pass(30), "!T!T!P!P*\r\n* 0\r\n");
}

TEST(Unit, is_within_its_limits_at_the_start) {
  Unit unit = quiet_unit(1e9, -1e9);
  EXPECT_EQ(unit.take(0, "pp tp "), "* 3090\r\n* -907\r\n");
}

}  // namespace
}  // namespace hc::pan_tilt
