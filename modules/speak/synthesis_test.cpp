// SPDX-License-Identifier: Apache-2.0
#include "synthesis.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <random>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "words.h"

namespace {

class SynthesisTest : public testing::Test {
 protected:
  SynthesisTest() : synthesis(std::move(*Synthesis::start())) {}
  Speech say(std::string_view text, const Voice& voice = {}) {
    auto said = synthesis.say(speakable(text), voice);
    EXPECT_TRUE(said) << said.error().text();
    return said ? std::move(*said) : Speech{};
  }
  [[nodiscard]] double loudness(const Speech& speech, double from, double to) const {
    const auto at = [&](double time) {
      return std::min(static_cast<std::size_t>(time * synthesis.rate()), speech.samples.size());
    };
    double sum = 0;
    for (std::size_t i = at(from); i < at(to); ++i) sum += std::abs(speech.samples[i]);
    return sum / std::max<double>(1, static_cast<double>(at(to) - at(from)));
  }
  [[nodiscard]] double seconds(const Speech& speech) const {
    return static_cast<double>(speech.samples.size()) / synthesis.rate();
  }
  Synthesis synthesis;
};

TEST_F(SynthesisTest, words_have_their_times) {
  EXPECT_EQ(synthesis.rate(), 22050);
  const auto speech = say("Grüße robot, hello.");
  ASSERT_EQ(speech.words.size(), 3);
  EXPECT_EQ(speech.words[0].word, U"Grüße");
  EXPECT_EQ(speech.words[1].word, U"robot");
  EXPECT_EQ(speech.words[2].word, U"hello");
  double last = 0;
  for (const auto& word : speech.words) {
    EXPECT_GE(word.start, last);
    EXPECT_GT(word.end, word.start + 0.1);
    EXPECT_GT(loudness(speech, word.start, word.end), 300);
    last = word.end;
  }
  EXPECT_LE(last, seconds(speech));
}

TEST_F(SynthesisTest, joined_words_have_their_times) {
  for (const std::string text :
       {"There are two books on the table.", "Do not wait for the bus.", "It is one of the best.",
        "I have been to the shop, and it was closed!", "He said: \"of the 12 apples\", no.",
        "of the", "Would you like some of this?", "That is what I will do in a moment."}) {
    const auto speech = say(text);
    std::string said, expected;
    double last = 0;
    for (const auto& word : speech.words) {
      said += utf8(word.word) + " ";
      EXPECT_GE(word.start, last - 1e-9) << text;
      EXPECT_GT(word.end, word.start) << text << ": " << utf8(word.word);
      last = word.end;
    }
    EXPECT_LE(last, seconds(speech) + 1e-9);
    for (const char c : text)
      if (std::isalnum(static_cast<unsigned char>(c)) != 0 || c == ' ') expected += c;
    expected += ' ';
    if (const auto at = expected.find("  "); at != expected.npos) expected.erase(at, 1);
    EXPECT_EQ(said, expected);
  }
}

TEST_F(SynthesisTest, what_is_said_in_several_parts_has_rows_that_do_not_overlap) {
  const std::pair<std::string, std::string> cases[] = {
      {"12345", "12345"},
      {"it costs 3.50 EUR or 1000000 YEN", "it costs 3.50 EUR or 1000000 YEN"},
      {"the 2nd of 3", "the 2nd of 3"},
      {"192.168.0.1 is home", "192.168.0.1 is home"},
      {"at 10:30 on 1/2/2026", "at 10 30 on 1 / 2 / 2026"},
      {"x86 and AT&T", "x 86 and AT&T"},
      {"100% of 007", "100 % of 007"}};
  for (const auto& [text, rows] : cases) {
    const auto speech = say(text);
    std::string said;
    double last = 0;
    for (const auto& word : speech.words) {
      said += (said.empty() ? "" : " ") + utf8(word.word);
      EXPECT_GE(word.start, last - 1e-9) << text;
      EXPECT_GT(word.end, word.start) << text;
      last = word.end;
    }
    EXPECT_EQ(said, rows);
    EXPECT_GT(last, 0.7 * seconds(speech)) << text;
  }
}

TEST_F(SynthesisTest, no_word_ends_before_it_begins) {
  for (const std::string text :
       {"b--( 2! (-.Ed(b-3?E3))a", "2b!'a?\?!3b. ?c d", "c1E2)?c3a).'E' c ??"}) {
    double last = 0;
    for (const auto& word : say(text, {.rate = 450}).words) {
      EXPECT_GE(word.start, last - 1e-9) << text << ": " << utf8(word.word);
      EXPECT_GE(word.end, word.start) << text << ": " << utf8(word.word);
      last = word.end;
    }
  }
}

TEST_F(SynthesisTest, the_voice_is_as_asked_for) {
  const auto plain = say("one two three four five");
  EXPECT_LT(seconds(say("one two three four five", {.rate = 300})), 0.8 * seconds(plain));
  EXPECT_GT(seconds(say("one two three four five", {.rate = 100})), 1.3 * seconds(plain));
  const auto silent = say("one two three four five", {.volume = 0});
  EXPECT_LT(loudness(silent, 0, 9), 2);
  EXPECT_LT(loudness(say("one two three four five", {.volume = 40}), 0, 9),
            0.7 * loudness(plain, 0, 9));
  EXPECT_NE(say("one", {.pitch = 90}).samples, say("one", {.pitch = 10}).samples);
  EXPECT_NE(say("one", {.name = "de"}).samples, say("one").samples);
}

TEST_F(SynthesisTest, says_which_voice_there_is_not) {
  for (const char* name : {"nosuch", "", "../../../etc/passwd", "/etc/passwd", "en\n"}) {
    auto said = synthesis.say(U"one", {.name = name});
    ASSERT_FALSE(said) << name;
    EXPECT_EQ(said.error().code, hc::Code::NotFound);
  }
  EXPECT_FALSE(say("one").samples.empty());  // and continues
}

TEST_F(SynthesisTest, markup_is_text) {
  // As SSML the first would be silent for a minute, and the second would be phonemes.
  const auto markup = say("<break time=\"60s\"/> one");
  EXPECT_LT(seconds(markup), 10);
  EXPECT_GT(markup.words.size(), 1);
  EXPECT_LT(seconds(say("<audio src=\"/etc/passwd\"/> one")), 15);
  EXPECT_GT(say("[[h@'loU]]").words.size(), 0);
}

TEST_F(SynthesisTest, any_bytes_do_no_harm) {
  std::mt19937 random(9);
  for (int i = 0; i < 60; ++i) {
    std::string bytes;
    for (auto size = random() % 60; bytes.size() < size;) bytes += static_cast<char>(random());
    const auto speech = say(bytes);
    for (const auto& word : speech.words) {
      EXPECT_GE(word.end, word.start);
      EXPECT_LE(word.start, seconds(speech) + 0.1);
    }
  }
  EXPECT_LT(seconds(say(std::string(5000, 'x'))), 601);
  EXPECT_TRUE(say("").words.empty());
}

}  // namespace
