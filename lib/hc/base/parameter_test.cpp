// SPDX-License-Identifier: Apache-2.0
#include <hc/base/parameter.h>

#include <gtest/gtest.h>

namespace hc {
namespace {

ParameterState state(ParameterValue value, ParameterOptions options = {}) {
  return {"p", "", "", std::move(options), value, value};
}

TEST(Parameter, ReadsItsOwnType) {
  auto flag = state(false);
  EXPECT_TRUE(flag.set("true"));
  EXPECT_TRUE(std::get<bool>(flag.value));
  EXPECT_FALSE(flag.set("yes"));
  auto integer = state(std::int64_t{1});
  EXPECT_TRUE(integer.set("-12"));
  EXPECT_EQ(text(integer.value), "-12");
  EXPECT_FALSE(integer.set("1.5"));
  EXPECT_FALSE(integer.set(""));
  auto number = state(0.5);
  EXPECT_TRUE(number.set("1e-3"));
  EXPECT_EQ(text(number.value), "0.001");
  EXPECT_FALSE(number.set("nan"));
  EXPECT_FALSE(number.set("3 m"));
  auto string = state(std::string("a"));
  EXPECT_TRUE(string.set(""));
  EXPECT_EQ(text(string.value), "");
}

TEST(Parameter, KeepsItsRange) {
  auto share = state(0.5, {.min = 0, .max = 1});
  EXPECT_TRUE(share.set("1"));
  EXPECT_EQ(share.set("1.01").error().detail, "parameter p: \"1.01\" is not from 0 to 1");
  EXPECT_EQ(text(share.value), "1");
  auto refusal = [](ParameterOptions options, const char* text) {
    return state(0.5, std::move(options)).set(text).error().detail;
  };
  EXPECT_EQ(refusal({.min = 0}, "-1"), "parameter p: \"-1\" is not at least 0");
  EXPECT_EQ(refusal({.max = 0}, "1"), "parameter p: \"1\" is not at most 0");
  EXPECT_EQ(refusal({}, "nan"), "parameter p: \"nan\" is not a number");
  auto side = state(std::int64_t{5}, {.min = 1, .max = 21, .step = 2});
  EXPECT_TRUE(side.set("21"));
  EXPECT_EQ(side.set("4").error().detail, "parameter p: \"4\" is not 1, 3, …, 21");
  EXPECT_EQ(side.set("23").error().detail, "parameter p: \"23\" is not 1, 3, …, 21");
  auto choice = state(std::string("auto"), {.choices = {"auto", "yes"}});
  EXPECT_TRUE(choice.set("yes"));
  EXPECT_EQ(choice.set("no").error().detail, "parameter p: \"no\" is not one of auto, yes");
}

}  // namespace
}  // namespace hc
