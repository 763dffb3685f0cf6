// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "drawing.h"
#include "observer.h"
#include "screen.h"

namespace tool {
namespace {

TEST(Observer, FindsGraphsAmongSockets) {
  auto found = find_running(
      "Num       RefCount Protocol Flags    Type St Inode Path\n"
      "0000: 00000002 00000000 00010000 0001 01 1 @hypercolumn.head.12\n"
      "0000: 00000003 00000000 00000000 0001 03 2 @hypercolumn.head.12\n"
      "0000: 00000002 00000000 00010000 0001 01 3 @hypercolumn.head.12.ask\n"
      "0000: 00000002 00000000 00010000 0001 01 4 @hypercolumn.a-B_2.7\n"
      "0000: 00000002 00000000 00010000 0001 01 5 @hypercolumn.head.x\n"
      "0000: 00000002 00000000 00010000 0001 01 6 /run/other\n"
      "0000: 00000002 00000000 00010000 0001 01 7\n");
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].text(), "a-B_2.7");
  EXPECT_EQ(found[1].text(), "head.12");
}

TEST(Observer, SocketsWithAnyOtherNameAreNoGraphs) {
  // Anybody may bind a name, with bytes that a terminal obeys; and whoever asks a graph listens.
  for (const std::string& name :
       {std::string("a.b.7"), std::string("\x1b[2J.7"), std::string("å.7"), std::string(".7"),
        std::string("a.-7"), std::string("a.0"), std::string("a."), std::string("a.7.ask"),
        std::string(41, 'a') + ".7"})
    EXPECT_TRUE(
        find_running("0000: 00000002 00000000 00010000 0001 01 1 @hypercolumn." + name + "\n")
            .empty())
        << name;
}

TEST(Screen, NumbersAreShort) {
  const std::pair<double, const char*> cases[] = {
      {0, "0"},         {1, "1"},         {30, "30"},        {1.5, "1.50"},   {999.4, "999"},
      {999.6, "1.00k"}, {12345, "12.3k"}, {0.0123, "12.3m"}, {2e-6, "2.00µ"}, {-1500, "-1.50k"},
      {5e9, "5.00G"},   {999499, "999k"}, {0.99999, "1.00"}};
  for (const auto& [number, text] : cases) EXPECT_EQ(short_number(number), text) << number;
}

nlohmann::json some_state(int modules) {
  nlohmann::json state = {{"graph", "head"},
                          {"file", "head.toml"},
                          {"pid", 12},
                          {"uptime", 65.2},
                          {"status", "running"},
                          {"modules", nlohmann::json::array()},
                          {"focus", {{"mode", "track"}, {"number", 1}}},
                          {"links", nlohmann::json::array()}};
  for (int i = 0; i < modules; ++i) {
    state["modules"].push_back({{"name", "module_" + std::to_string(i)},
                                {"program", "camera"},
                                {"pid", 100 + i},
                                {"status", i == 3 ? "given up" : "running"},
                                {"detail", i == 3 ? "failed with status 1" : ""},
                                {"restarts", i},
                                {"exit", nullptr},
                                {"cpu", 0.031},
                                {"memory", 1234567},
                                {"mode", i == 1 ? "track" : ""},
                                {"modes", nlohmann::json::array()},
                                {"in_focus", i != 2},
                                {"in_workspace", i == 1},
                                {"parameters", nlohmann::json::object()}});
    state["links"].push_back({{"from", "module_" + std::to_string(i) + ".left"},
                              {"to", "tcp:robot:7000"},
                              {"keep", i == 1 ? "latest" : "all"},
                              {"rate", i == 1 ? 30.0 : 0.0},
                              {"per_second", 30.0},
                              {"bytes_per_second", 43.2e6},
                              {"lost", {{"superseded", i}}},
                              {"left_out", i == 0 ? 1234 : 0},
                              {"age", {0.0021, 0.0102, 0.5}},
                              {"in_workspace", i == 1}});
  }
  return state;
}

TEST(Screen, ShowsWhatFitsAndWhatIsWrongFirst) {
  std::string all = draw(some_state(2), {80, 0, true});
  EXPECT_EQ(all,
            "head: running 1:05 min, 2/2 modules up, 60 messages/s, 6 % CPU, focus track\n"
            "\n"
            "MODULE                CPU   MEMORY NEW MODE    STATUS\n"
            "module_0             3.1%  1.23 MB   0         running\n"
            "module_1             3.1%  1.23 MB   1 track   running\n"
            "\n"
            "LINK                                     1/s    B/s    AGE    p99  LOST LEFT OUT\n"
            "module_0.left → tcp:robot:7000            30 43.2MB 2.10ms 10.2ms     -    1.23k\n"
            "module_1.left → tcp:robot:7000 ≤30/s      30 43.2MB 2.10ms 10.2ms     1        -\n");
  std::string some = draw(some_state(50), {80, 24, true});
  EXPECT_EQ(std::count(some.begin(), some.end(), '\n'), 24);
  EXPECT_NE(some.find("given up: failed with status 1"), std::string::npos);
  EXPECT_NE(some.find("… and 41 more"), std::string::npos) << some;
  for (std::size_t begin = 0, end = 0; (end = some.find('\n', begin)) != std::string::npos;
       begin = end + 1) {
    auto line = some.substr(begin, end - begin);
    EXPECT_LE(std::count_if(line.begin(), line.end(),
                            [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }),
              80)
        << line;
  }
}

TEST(Screen, TellsWhatARunningModuleWaitsFor) {
  auto state = some_state(1);
  state["modules"][0]["detail"] = "waits for a reader";
  EXPECT_NE(draw(state, {80, 0, true}).find("waits for a reader\n"), std::string::npos);
  EXPECT_EQ(drawing_of(state).boxes.at(0).words, "waits for a reader");
}

TEST(Screen, IsMadeOfAnySize) {
  for (std::size_t width : {1U, 20U, 40U, 300U})
    for (std::size_t height : {1U, 2U, 5U, 6U, 100U})
      EXPECT_FALSE(draw(some_state(7), {width, height, false}).empty());
}

TEST(Drawing, HasPortsRatesAndTheWorkspaceInBold) {
  auto drawing = drawing_of(some_state(2));
  EXPECT_EQ(as_text(drawing, true),
            "head, focus: track\n"
            "\nmodule_0  (3.1 %)\n  left → tcp:robot:7000  30/s\n"
            "\nmodule_1  (3.1 %)\n  left → tcp:robot:7000  30/s, keep latest, rate 30\n");
  EXPECT_NE(as_text(drawing, false).find("\x1b[1mmodule_1\x1b[0m"), std::string::npos);
  auto dot = as_dot(drawing);
  EXPECT_NE(dot.find("\"module_1\" [label=\"module_1\n3.1 %\", penwidth=3];"), std::string::npos);
  EXPECT_NE(dot.find("\"module_1\" -> \"tcp:robot:7000\" [taillabel=\"left\", headlabel=\"\", "
                     "label=\"30/s, keep latest, rate 30\", penwidth=3, color=black];"),
            std::string::npos)
      << dot;
}

}  // namespace
}  // namespace tool
