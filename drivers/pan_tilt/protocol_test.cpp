// SPDX-License-Identifier: Apache-2.0
#include <drivers/pan_tilt/protocol.h>

#include <gtest/gtest.h>

#include <vector>

namespace hc::pan_tilt {
namespace {

using Kind = Reply::Kind;

/// Replies and errors, as text: "Result 22".
std::vector<std::string> read(const std::vector<std::string>& pieces) {
  constexpr const char* kNames[] = {"Done", "Result", "Refused", "PanLimit", "TiltLimit"};
  ReplyReader reader;
  std::vector<std::string> said;
  for (const auto& piece : pieces) {
    reader.feed(piece);
    while (auto reply = reader.next()) {
      if (!*reply) {
        said.push_back((*reply).error().text());
        continue;
      }
      std::string line = kNames[static_cast<int>((*reply)->kind)];
      if (!(*reply)->text.empty()) line += " " + (*reply)->text;
      said.push_back(line);
    }
  }
  return said;
}

std::vector<std::string> single_bytes(const std::string& text) {
  std::vector<std::string> pieces;
  for (char byte : text) pieces.emplace_back(1, byte);
  return pieces;
}

TEST(Protocol, commands_end_with_a_space) {
  EXPECT_EQ(command("pp"), "pp ");
  EXPECT_EQ(command("pp", -200), "pp-200 ");
}

TEST(Protocol, replies_come_in_pieces_of_any_size) {
  const std::string text =
      "*\r\n* 22\r\n! Maximum allowable Pan position is 3090\r\n!T!T!P!P*\r\n*  -907 \n* "
      "185.1428\r";
  const std::vector<std::string> expected = {
      "Done",           "Result 22", "Refused Maximum allowable Pan position is 3090",
      "TiltLimit",      "TiltLimit", "PanLimit",
      "PanLimit",       "Done",      "Result -907",
      "Result 185.1428"};
  EXPECT_EQ(read({text}), expected);
  EXPECT_EQ(read(single_bytes(text)), expected);
}

TEST(Protocol, garbage_is_one_error_and_ends_with_its_line) {
  EXPECT_EQ(
      read({"pp * 22\r\n* 23\r\n"}),
      (std::vector<std::string>{"Malformed: garbage: 0x70 does not start a reply", "Result 23"}));
  EXPECT_EQ(read({"* 2\xff\xfe\xfd\r\n*\r\n"}),
            (std::vector<std::string>{"Malformed: garbage: 0xff in a reply", "Done"}));
  EXPECT_EQ(read(single_bytes("* 2\xff\xfe\xfd\r\n*\r\n")).size(), 2U);
}

TEST(Protocol, a_line_without_end_is_refused_at_its_bound) {
  const auto said =
      read({"* " + std::string(100'000, '1'), std::string(100'000, '2') + "\r\n* 5\r"});
  EXPECT_EQ(said, (std::vector<std::string>{"TooLarge: garbage: a reply of more than 128 bytes",
                                            "Result 5"}));
}

TEST(Protocol, a_cut_reply_waits) {
  EXPECT_TRUE(read({"* 22"}).empty());
  EXPECT_TRUE(read({"!"}).empty());
  EXPECT_TRUE(read({"\r\n \r\n"}).empty());
}

TEST(Protocol, numbers_are_all_of_the_text) {
  EXPECT_EQ(*number("-907"), -907);
  EXPECT_EQ(*number("185.1428"), 185.1428);
  for (const char* text : {"", "12x", "nan", "inf", "1e999", "22 seconds"})
    EXPECT_EQ(number(text).error().code, Code::Malformed) << text;
}

}  // namespace
}  // namespace hc::pan_tilt
