// SPDX-License-Identifier: Apache-2.0
#include <graph/graph_file.h>

#include <gtest/gtest.h>

#include <cstring>

#include <hc/testing/must.h>

namespace hc {
namespace {

const char* environment(const char* name) {
  return std::strcmp(name, "HOME") == 0 ? "/home/eve" : nullptr;
}

/// Parses a graph after the line of its version. Errors: all problems, a line each.
Result<Graph> parse(std::string_view text) {
  Problems problems("g.toml");
  Graph graph = parse_graph("version = 1\n" + std::string(text), environment, problems);
  if (problems.empty()) return graph;
  std::string all;
  for (const auto& line : problems.lines()) all += (all.empty() ? "" : "\n") + line;
  return Error{Code::Invalid, all};
}

TEST(GraphFile, HasModulesInTheirOrderAndLinks) {
  auto graph = must(parse(R"(
[modules.eyes]
program = "camera"
parameters = { source = "${HOME}/a.jpg", right_source = "${PICTURE:-b.jpg}", rate = 2.5, count = 3, loop = true }
addresses = { left = 11 }
encodings = { left = "jpeg" }

[modules.depth]
inputs.left = "eyes.left"
)"));
  ASSERT_EQ(graph.modules.size(), 2U);
  const auto& eyes = graph.modules[0];
  EXPECT_EQ(eyes.name, "eyes");
  EXPECT_EQ(eyes.program.value, "camera");
  EXPECT_EQ(eyes.parameters.at("source").value, "/home/eve/a.jpg");
  EXPECT_EQ(eyes.parameters.at("right_source").value, "b.jpg");
  EXPECT_EQ(eyes.parameters.at("rate").value, "2.5");
  EXPECT_EQ(eyes.parameters.at("count").value, "3");
  EXPECT_EQ(eyes.parameters.at("loop").value, "true");
  EXPECT_EQ(eyes.addresses.at("left").value, 11);
  EXPECT_EQ(eyes.encodings.at("left").value, Encoding::Jpeg);
  EXPECT_EQ(graph.modules[1].program.value, "depth");
  ASSERT_EQ(graph.links.size(), 1U);
  EXPECT_EQ(graph.links[0].from.text(), "eyes.left");
  EXPECT_EQ(graph.links[0].place.line, 10);
}

TEST(GraphFile, HasAVersion) {
  auto wrong = [](const std::string& text) {
    Problems problems("g.toml");
    parse_graph(text, environment, problems);
    return problems.empty() ? "" : problems.lines().front();
  };
  for (const char* mark : {"", "\xef\xbb\xbf"})  // a byte order mark is ignored
    EXPECT_EQ(wrong(mark + std::string("version = 1\n[modules.a]\n")), "");
  EXPECT_EQ(wrong("\n[modules.a]\n"), "g.toml:1: a graph file begins with \"version = 1\"");
  EXPECT_EQ(wrong("\nversion = \"1\"\n"), "g.toml:2: a graph file has \"version = 1\"");
  EXPECT_EQ(wrong("version = 2\n[modles.a]\n"),
            "g.toml:1: this file has version 2, and this hc reads version 1: update hc");
}

TEST(GraphFile, InputsNameTheirWritersAndOutputsTheOutside) {
  auto graph = must(parse(R"([modules.a]
inputs.in = ["b.out", { from = ["c.out", "${URI:-tcp:1}"], keep = "latest", rate = "${RATE:-3}" }]
outputs.out = { to = ["file:x", "tcp:2"], route = [3, -1] }
outputs.other = "tcp-listen:3"
)"));
  std::string text;
  for (const auto& link : graph.links) {
    text += link.from.text() + " " + link.to.text();
    for (const auto& [key, value] : link.policy) text += " " + key + "=" + value.value;
    text += link.route ? " route\n" : "\n";
  }
  EXPECT_EQ(text,
            "b.out a.in\nc.out a.in keep=latest rate=3\ntcp:1 a.in keep=latest rate=3\n"
            "a.out file:x route\na.out tcp:2 route\na.other tcp-listen:3\n");
}

TEST(GraphFile, TimeoutAndHangAtTheTopAreDefaults) {
  auto graph = must(parse(R"(timeout = 9
hang = 7
[modules.a]
inputs.in = ["b.out", { from = "c.out", timeout = 0 }, "tcp:1"]
[modules.b]
hang = 0
)"));
  std::string text;
  for (const auto& link : graph.links)
    text += link.policy.contains("timeout") ? link.policy.at("timeout").value + " " : "none ";
  EXPECT_EQ(text, "9 0 none ") << "a link from outside is its sender's affair";
  EXPECT_EQ(graph.modules[0].hang.value, 7);
  EXPECT_EQ(graph.modules[1].hang.value, 0);
  EXPECT_FALSE(parse("hang = -1\n[modules.a]\n"));
  EXPECT_FALSE(parse("[modules.a]\ninputs.in = { from = \"b.out\", timeout = \"some\" }\n"));
}

TEST(GraphFile, LettersOutsideAsciiAndTildesComeThrough) {
  auto graph = must(parse("# größe → ~\n[modules.a]\nparameters.p = \"grün ~/x~y ~7\"\n"));
  EXPECT_EQ(graph.modules[0].parameters.at("p").value, "grün ~/x~y ~7");
}

TEST(GraphFile, TildesAreNoEscapes) {
  const auto refused = parse("[modules.a]\nparameters.p = \"\\u007e41\"\n");
  EXPECT_EQ(refused.error().detail, "g.toml:3: write ~ itself, not its \\u escape");
  EXPECT_FALSE(parse("[modules.a]\nparameters.p = \"\\U0000007E41\"\n"));
  auto graph = must(parse("[modules.a]\nparameters.p = \"\\\\u007e41 \\u0041\"\n"));
  EXPECT_EQ(graph.modules[0].parameters.at("p").value, "\\u007e41 A");
}

TEST(GraphFile, ErrorsNameTheLineAndWhatWouldBeRight) {
  const std::pair<const char*, const char*> cases[] = {
      {"", "g.toml:1: a graph needs a table [modules.NAME] for each of its modules"},
      {"[modules.a]\nprogam = \"x\"",
       "g.toml:3: unknown key \"progam\" in module a, did you mean \"program\"?"},
      {"[modules.\"a\\nb\"]\n", "g.toml:2: module name \"a\\x0ab\" is not snake_case"},
      {"[modules.A]\n", "g.toml:2: module name \"A\" is not snake_case"},
      {"[modules]\na = 1", "g.toml:3: \"a\" must be a table"},
      {"[modules.a]\nprogram = 3", "g.toml:3: \"program\" must be a string"},
      {"[modules.a]\nparameters = 3", "g.toml:3: \"parameters\" must be a table"},
      {"[modules.a]\nparameters.p = [1]",
       "g.toml:3: parameter \"p\" must be a string, a number, true or false"},
      {"[modules.a]\nparameters.p = \"${NO}\"",
       "g.toml:3: environment variable NO is not set; ${NO:-VALUE} gives a default"},
      {"[modules.a]\nparameters.p = \"${NO\"", "g.toml:3: \"${\" without \"}\""},
      {"[modules.a]\nparameters.p = \"${NO:-${HOME}}\"",
       "g.toml:3: variables do not nest: the default of ${NO} has a \"${\"; name one variable, or "
       "write its value"},
      {"[modules.a]\naddresses.o = -1",
       "g.toml:3: \"o\" must be a whole number from 0 to 2147483647"},
      {"[modules.a]\nencodings.o = 1",
       "g.toml:3: \"o\" must be \"text\", \"binary\", \"zstd\" or \"jpeg\""},
      {"[modules.a]\ninputs = 3", "g.toml:3: \"inputs\" must be a table"},
      {"[modules.a]\ninputs.b = 3", "g.toml:3: \"b\" must be a string"},
      {"[modules.a]\ninputs.b = \"a\"", "g.toml:3: \"a\" is not MODULE.PORT"},
      {"[modules.a]\ninputs.b = { keep = 3 }", "g.toml:3: \"from\" is missing in a link of a.b"},
      {"[modules.a]\ninputs.b = { from = \"a.b\", by = 3 }",
       "g.toml:3: unknown key \"by\" in a link of a.b"},
      {"[modules.a]\noutputs.b = \"a.b\"", "g.toml:3: \"a.b\" is not a URI"},
      {"[module.a]\n",
       "g.toml:2: unknown key \"module\" at the top of the file, did you mean \"modules\"?"},
      {"[modules.a\n", "g.toml:2: "},
      {"\n\nx = \"ü", "g.toml:4: "},
  };
  for (const auto& [text, wanted] : cases) {
    const auto graph = refused(parse(text));
    EXPECT_EQ(graph.code, Code::Invalid);
    EXPECT_TRUE(graph.detail.starts_with(wanted)) << graph.detail;
  }
  EXPECT_FALSE(parse(std::string(kMaxGraphBytes + 1, '\n')));
}

std::string repeated(std::string_view text, std::size_t times) {
  std::string all;
  while (times-- > 0) all += text;
  return all;
}

TEST(GraphFile, DepthIsLimitedAndTheStackHoldsOut) {
  const std::string deep = repeated("a.", 400'000) + "a";
  const std::string key = deep + " = 1\n";
  const std::string quoted = repeated("\"x/\\\"\" . 'y' .\t", 50'000) + "a = 1\n";
  const std::string texts[] = {"[" + deep + "]\n",
                               "[[" + deep + "]]\n",
                               key,
                               quoted,
                               "x = '''a'''''\n" + key,
                               "x = \"\"\"a\\\"\"\"\"\"\n" + key,
                               "x = ''\n" + key,
                               "x = [ # [[[\n{ " + key,
                               "x = " + repeated("[", 400'000),
                               "x = " + repeated("{a=", 300'000),
                               "x = \"\n" + key};
  for (const std::string& text : texts) {
    const auto graph = refused(parse("# \"\n" + text));
    EXPECT_TRUE(graph.detail.starts_with("g.toml:")) << graph.detail;
  }
  EXPECT_EQ(parse("\n" + key).error().detail,
            "g.toml:3: at most 16 dots in a key, and as many nested brackets");
}

TEST(GraphFile, TheDeepestThatIsAllowedIsRead) {
  std::string key = repeated("a.", kMaxGraphDepth) + "a";
  std::string text = "[modules." + repeated("a.", kMaxGraphDepth - 1) + "a]\n" + key + " = ";
  text += repeated("{" + key + " = ", kMaxGraphDepth) + "1" + repeated("}", kMaxGraphDepth);
  EXPECT_EQ(parse(text).error().detail, "g.toml:2: unknown key \"a\" in module a");
}

TEST(GraphFile, AGraphHasAThousandModules) {
  auto modules = [](std::size_t count) {
    std::string text;
    for (std::size_t i = 0; i < count; ++i) text += "[modules.m" + std::to_string(i) + "]\n";
    return text;
  };
  EXPECT_TRUE(parse(modules(kMaxModules)));
  EXPECT_EQ(parse(modules(kMaxModules + 2)).error().detail,
            "g.toml:1002: a graph has at most 1000 modules");
}

TEST(GraphFile, DotsAndBracketsInStringsAndCommentsAreFree) {
  std::string many = repeated("../[{", 1000) + repeated(".", 1000);
  auto graph = must(parse("[modules.a] # " + many + "\nparameters = { b = \"" + many +
                          "\\\"\", c = '" + many + "', d = \"\"\"" + many + "\n\"\"" + many +
                          "\"\"\"\"\", e = '''" + many + "''''', f = \"\", g = '' }\n"));
  const auto& parameters = graph.modules[0].parameters;
  EXPECT_EQ(parameters.at("b").value, many + "\"");
  EXPECT_EQ(parameters.at("c").value, many);
  EXPECT_EQ(parameters.at("d").value, many + "\n\"\"" + many + "\"\"");
  EXPECT_EQ(parameters.at("e").value, many + "''");
}

TEST(GraphFile, ParametersAreSetFromOutside) {
  auto graph = parse("[modules.camera]\nparameters.rate = 1\n");
  Problems problems("g.toml");
  set_parameter(*graph, {"camera", "rate", "5=6"}, problems, kCommandLine);
  EXPECT_TRUE(problems.empty());
  EXPECT_EQ(graph->modules[0].parameters.at("rate").value, "5=6");
  set_parameter(*graph, {"camra", "rate", "5"}, problems, kCommandLine);
  EXPECT_EQ(
      problems.lines(),
      (std::vector<std::string>{"--set: no module \"camra\" in g.toml, did you mean \"camera\"?"}));
}

TEST(GraphFile, NumbersAreAsShortAsTheyCanBe) {
  const auto graph = must(parse("[modules.a]\nparameters = { a = 0.05, b = 1e-7, c = 2.0 }\n"));
  const auto& parameters = graph.modules[0].parameters;
  EXPECT_EQ(parameters.at("a").value, "0.05");
  EXPECT_EQ(parameters.at("b").value, "1e-07");
  EXPECT_EQ(parameters.at("c").value, "2");
}

TEST(GraphFile, AllErrorsAreReportedAtOnceInTheOrderOfTheLines) {
  const auto refused = parse(R"(speed = 3
[modules.Eye]
program = 3
parameters = { a = [], b = "${NO}" }
addresses.left = -1
encodings.left = "gif"
[[modules.Eye.inputs.in]]
from = "eye"
keep = "some"
burst = 4
)");
  EXPECT_EQ(refused.error().detail, R"(g.toml:2: unknown key "speed" at the top of the file
g.toml:3: module name "Eye" is not snake_case
g.toml:4: "program" must be a string
g.toml:5: environment variable NO is not set; ${NO:-VALUE} gives a default
g.toml:5: parameter "a" must be a string, a number, true or false
g.toml:6: "left" must be a whole number from 0 to 2147483647
g.toml:7: "left" must be "text", "binary", "zstd" or "jpeg"
g.toml:9: "eye" is not MODULE.PORT
g.toml:10: )" + std::string("option keep is all, latest, or a number of messages"));
}

}  // namespace
}  // namespace hc
