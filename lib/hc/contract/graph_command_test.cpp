// SPDX-License-Identifier: Apache-2.0
#include <hc/contract/graph_command.h>

#include <gtest/gtest.h>

namespace hc {
namespace {

using Rows = std::vector<std::string>;

TEST(GraphCommand, a_value_may_hold_anything) {
  const auto command = parse_graph_command("set  camera.set=a = b.c  d");
  ASSERT_TRUE(command) << command.error().detail;
  EXPECT_EQ(command->words, (Rows{"camera", "set", "a = b.c  d"}));
  EXPECT_TRUE(command->is_edit());
}

TEST(GraphCommand, questions_change_nothing) {
  for (const char* line :
       {"describe camera", "observe camera.left", "feed view.image", "notices"}) {
    const auto command = parse_graph_command(line);
    ASSERT_TRUE(command) << command.error().detail;
    EXPECT_TRUE(command->is_question());
    EXPECT_FALSE(command->is_edit());
  }
}

TEST(GraphCommand, what_is_wrong_is_named) {
  for (const auto& [line, words] : std::vector<std::pair<std::string, std::string>>{
           {"", "there is no command"},
           {"   ", "there is no command"},
           {"ad x y", "no command \"ad\", did you mean \"add\"?"},
           {"add x", "usage: add MODULE[@HOST] PROGRAM [PARAMETER=VALUE ...]"},
           {"stop now", "usage: stop"},
           {"describe", "usage: describe MODULE"},
           {"observe a.b c.d", "usage: observe MODULE.PORT"},
           {"set", "usage: set MODULE.PARAMETER=VALUE"},
           {"set rate=5", "\"rate=5\" is not MODULE.PARAMETER=VALUE"},
           {"set camera.rate", "\"camera.rate\" is not MODULE.PARAMETER=VALUE"}}) {
    const auto command = parse_graph_command(line);
    ASSERT_FALSE(command) << line;
    EXPECT_EQ(command.error().detail, words);
  }
}

TEST(GraphCommand, a_request_says_where_its_answer_goes) {
  const auto asked = read_request(make_request({"unix:@me", {"stop", "restart view"}}));
  EXPECT_EQ(asked.reply, "unix:@me");
  EXPECT_EQ(asked.lines, (Rows{"stop", "restart view"}));
  const auto told = read_request(make_request({"", {"stop"}}));
  EXPECT_EQ(told.reply, "");
  EXPECT_EQ(told.lines, (Rows{"stop"}));
  EXPECT_TRUE(read_request(make_request({"", {}})).lines.empty());
}

TEST(GraphCommand, an_answer_is_ok_or_says_what_is_wrong) {
  const auto good = read_answer(make_answer({true, {"shm:x"}}));
  EXPECT_TRUE(good.is_ok);
  EXPECT_EQ(good.rows, (Rows{"shm:x"}));
  const auto bad = read_answer(make_answer({false, {"no module \"a\"", "no host \"b\""}}));
  EXPECT_FALSE(bad.is_ok);
  EXPECT_EQ(bad.rows, (Rows{"no module \"a\"", "no host \"b\""}));
  EXPECT_EQ(read_answer(make_answer({false, {}})).rows, (Rows{"an empty answer"}));
}

}  // namespace
}  // namespace hc
