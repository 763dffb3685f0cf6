// SPDX-License-Identifier: Apache-2.0
#include "words.h"

#include <random>

#include <gtest/gtest.h>

namespace {

TEST(Speakable, text_is_as_it_was) {
  EXPECT_EQ(speakable("Hello, robot!"), U"Hello, robot!");
  EXPECT_EQ(speakable("Grüße, Καλημέρα, 你好, 🙂"),
            U"Grüße, Καλημέρα, 你好, 🙂");
  EXPECT_EQ(utf8(U"Grüße, Καλημέρα, 你好, 🙂"),
            "Grüße, Καλημέρα, 你好, 🙂");
}

TEST(Speakable, controls_and_what_is_no_text_become_spaces) {
  EXPECT_EQ(speakable(std::string("a\0b", 3)), U"a b");
  EXPECT_EQ(speakable("a\x01+50Sb\x1B[2Jc\x7F"), U"a +50Sb [2Jc ");
  EXPECT_EQ(speakable("two\nlines\r\n\tmore"), U"two lines more");
  EXPECT_EQ(speakable("\xC2\x9B"
                      "x"),
            U" x");  // a control of Latin-1
  EXPECT_EQ(speakable("\xE2\x80\xAE"
                      "x"),
            U" x");  // from right to left
  EXPECT_EQ(speakable("\xEE\x80\x80"
                      "x"),
            U" x");  // for private use
  EXPECT_EQ(speakable("a\xFF\xC0\x80"
                      "b"),
            U"a b");  // no UTF-8, and a long form of 0
  EXPECT_EQ(speakable("\xED\xA0\x80"
                      "b"),
            U" b");  // half a pair
  EXPECT_EQ(speakable("\xF4\x90\x80\x80"
                      "b"),
            U" b");                          // beyond Unicode
  EXPECT_EQ(speakable("b\xE4\xBD"), U"b ");  // cut
}

TEST(Speakable, is_bounded) {
  EXPECT_EQ(speakable(std::string(100000, '.') + "x", 50).size(), 50);
  const auto broken = speakable(std::string(130, 'a'));
  EXPECT_EQ(broken, std::u32string(60, U'a') + U" " + std::u32string(60, U'a') + U" " +
                        std::u32string(10, U'a'));
  EXPECT_LE(speakable(std::string(1000000, 'a')).size(), 2001);
}

TEST(Speakable, any_bytes_give_text_that_comes_back) {
  std::mt19937 random(5);
  for (int i = 0; i < 2000; ++i) {
    std::string bytes;
    for (auto size = random() % 40; bytes.size() < size;) bytes += static_cast<char>(random());
    const auto text = speakable(bytes);
    EXPECT_EQ(speakable(utf8(text)), text);
  }
}

TEST(Speakable, blank_is_nothing_to_say) {
  EXPECT_TRUE(is_blank(speakable("")));
  EXPECT_TRUE(is_blank(speakable(" \n\t\x01 ")));
  EXPECT_FALSE(is_blank(speakable(" a ")));
}

TEST(TextQueue, keeps_the_newest_in_their_order) {
  TextQueue queue;
  EXPECT_FALSE(queue.push({U"a", hc::unix_time(1), 0}, 2));
  EXPECT_FALSE(queue.push({U"b", hc::unix_time(2), 0}, 2));
  EXPECT_TRUE(queue.push({U"c", hc::unix_time(3), 7}, 2));
  EXPECT_EQ(queue.pop().characters, U"b");
  const auto last = queue.pop();
  EXPECT_EQ(last.characters, U"c");
  EXPECT_EQ(last.time, hc::unix_time(3));
  EXPECT_EQ(last.mode, 7);
  EXPECT_TRUE(queue.empty());
}

}  // namespace
