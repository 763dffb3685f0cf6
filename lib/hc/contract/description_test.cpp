// SPDX-License-Identifier: Apache-2.0
#include <hc/contract/description.h>

#include <gtest/gtest.h>

namespace hc {
namespace {

TEST(Description, ComesBackAsItWasWritten) {
  Description description;
  description.name = "blob";
  description.summary = "Finds \"it\".";
  description.inputs = {{"image",
                         "an image",
                         {{{MatrixType::RgbImage, 3, Scalar::U8, Encoding::Binary}, 0, 0, 7}},
                         true,
                         16},
                        {"any", "", {}}};
  description.outputs = {
      {"pose", "", {{{MatrixType::Transformation, 1, Scalar::F64, Encoding::Binary}, 4, 4, 0}}},
      {"bids", "", {{{MatrixType::Table, 1, Scalar::F64, Encoding::Text}, 2, 0, 0}}}};
  description.outputs[1].columns = {"mode", "age [s]"};
  description.together = {{"image", "any"}};
  ParameterState rate{"rate", "Hz", "how often", {}, 0.5, 0.5};
  rate.options.min = 0;
  rate.options.fixed = true;
  ParameterState count{"count", "", "", {}, std::int64_t{-3}, std::int64_t{-3}};
  ParameterState how{"how", "", "", {}, std::string("fast"), std::string("fast")};
  how.options.choices = {"fast", "good"};
  description.parameters = {rate, count, how, {"loop", "", "", {}, true, true}};
  description.transports = {{"tcp", "shm"}};
  description.control = true;
  const auto json = to_json(description);
  EXPECT_EQ(json.find('\n'), std::string::npos);
  auto parsed = parse_description(json);
  ASSERT_TRUE(parsed) << json;
  EXPECT_EQ(to_json(*parsed), json);
  EXPECT_EQ(parsed->inputs[0].keep, 16U);
  EXPECT_EQ(parsed->inputs[1].keep, 0U);
  EXPECT_EQ(in_words(parsed->outputs[1]), "table 2 x any of 1 x f64: mode, age [s]");
  EXPECT_EQ(std::get<double>(parsed->parameters[0].default_value), 0.5);
  EXPECT_TRUE(std::get<bool>(parsed->parameters[3].default_value));
  EXPECT_TRUE(parsed->knows("tcp"));
  EXPECT_FALSE(parsed->knows("unix"));
}

TEST(Description, PortsAndParametersAreEnough) {
  auto parsed = parse_description(R"({"inputs":[],"outputs":[],"parameters":[]})");
  ASSERT_TRUE(parsed);
  EXPECT_TRUE(parsed->knows("unix"));
  EXPECT_FALSE(parsed->knows("shm"));
  EXPECT_EQ(find_input(*parsed, "focus"), nullptr);
  EXPECT_EQ(find_output(*parsed, "trace"), nullptr);
  parsed->control = true;
  ASSERT_NE(find_input(*parsed, "focus"), nullptr);
  EXPECT_EQ(in_words(find_input(*parsed, "focus")->types), "table 1 x 1 of 1 x i32");
  EXPECT_EQ(find_output(*parsed, "trace"), &trace_output());
}

TEST(Description, WhatIsNoneIsRefused) {
  const std::string type =
      R"({"type":"map","components":1,"scalar":"f32","width":0,"height":0,"coord":0})";
  auto with = [&](const std::string& port_types, const std::string& parameter) {
    return parse_description(R"({"inputs":[{"name":"in","types":[)" + port_types +
                             R"(]}],"outputs":[],"parameters":[)" + parameter + "]}")
        .has_value();
  };
  auto changed = [&](const std::string& from, const std::string& to) {
    std::string other = type;
    return other.replace(other.find(from), from.size(), to);
  };
  EXPECT_TRUE(with(type, ""));
  EXPECT_FALSE(with(changed("\"map\"", "\"mop\""), ""));
  EXPECT_FALSE(with(changed("\"f32\"", "32"), ""));
  EXPECT_FALSE(with(changed(":1,", ":300,"), ""));
  EXPECT_FALSE(with(changed("\"width\":0", "\"width\":-1"), ""));
  EXPECT_FALSE(with(changed("\"coord\":0", "\"coord\":99999999999"), ""));
  EXPECT_FALSE(with(changed("\"width\":0,", ""), ""));
  for (const char* keep : {"-1", "1.5", "\"all\"", "99999999999"})
    EXPECT_FALSE(parse_description(R"({"inputs":[{"name":"in","types":[],"keep":)" +
                                   std::string(keep) + R"(}],"outputs":[],"parameters":[]})"))
        << keep;
  EXPECT_TRUE(with("", R"({"name":"a","type":"integer","min":1,"step":2,"default":null})"));
  EXPECT_FALSE(with("", R"({"name":"a","type":"float"})"));
  EXPECT_FALSE(with("", R"({"name":"a","type":"integer","step":0})"));
  EXPECT_FALSE(with("", R"({"name":"a","type":"string","choices":[1]})"));
  for (const char* text : {"", "hello", "3", "[]", "{}", R"({"inputs":{},"outputs":[]})"})
    EXPECT_FALSE(parse_description(text)) << text;
  EXPECT_FALSE(parse_description(std::string(1 << 20, '[')));
}

TEST(Description, NamesOfPortsAreSnakeCase) {
  auto with = [](const std::string& input, const std::string& output) {
    Description description;
    description.inputs.emplace_back().name = input;
    description.outputs.emplace_back().name = output;
    const auto checked = check_names(description);
    return checked ? "" : checked.error().detail;
  };
  EXPECT_EQ(with("in", "out_2"), "");
  EXPECT_EQ(with("in", "Out"), "output name \"Out\" is not snake_case");
  EXPECT_EQ(with("2nd", "out"), "input name \"2nd\" is not snake_case");
}

}  // namespace
}  // namespace hc
