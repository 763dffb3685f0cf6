// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "drawing.h"
#include "observer.h"
#include "screen.h"

namespace tool {
namespace {

TEST(Screen, NumbersAreShort) {
  const std::pair<double, const char*> cases[] = {
      {0, "0"},          {1, "1"},         {30, "30"},       {1.5, "1.50"},
      {999.4, "999"},    {999.6, "1.00k"}, {0.243, "0.24"},  {12345, "12.3k"},
      {-1500, "-1.50k"}, {5e9, "5.00G"},   {999499, "999k"}, {0.99999, "1.00"}};
  for (const auto& [number, text] : cases) EXPECT_EQ(short_number(number), text) << number;
  const std::pair<double, const char*> times[] = {
      {-1, "-"}, {0.0021, "2.10ms"}, {2e-6, "2µs"}, {1.5, "1.50s"}, {3e-9, "3ns"}};
  for (const auto& [seconds, text] : times) EXPECT_EQ(short_time(seconds), text) << seconds;
}

hc::GraphState some_state(int modules) {
  hc::GraphState state;
  state.name = "head";
  state.uptime = 65.2;
  state.modes = {{"track", 1}};
  state.focus = {{"judge", 1}};
  for (int i = 0; i < modules; ++i) {
    auto& module = state.modules.emplace_back();
    module.name = "module_" + std::to_string(i);
    module.status = i == 3 ? hc::ModuleStatus::GivenUp : hc::ModuleStatus::Running;
    module.detail = i == 3 ? "failed with status 1" : "";
    module.restarts = i;
    module.processor = 0.031;
    module.memory = 1234567;
    module.mode = i == 1 ? "track" : "";
    module.workspace = "judge";
    module.in_focus = i != 2;
    module.in_workspace = i == 1;
    auto& link = state.links.emplace_back();
    link.from = module.name + ".left";
    link.to = "tcp:robot:7000";
    link.keep = i == 1 ? "latest" : "all";
    link.rate = i == 1 ? 30 : 0;
    link.per_second = 30;
    link.bytes_per_second = 43.2e6;
    link.traffic.dropped_newer = static_cast<std::uint64_t>(i);
    link.traffic.throttled = static_cast<std::uint64_t>(2 * i);
    link.ignored = i == 0 ? 1234 : 0;
    link.age = {0.0021, 0.0102, 0.5};
    link.in_workspace = i == 1;
  }
  return state;
}

TEST(Screen, ShowsModulesAndLinks) {
  auto state = some_state(2);
  state.modules[0].last_line = "ready";
  EXPECT_EQ(
      draw(state, {{"", "track", 0.6, true, false}, {"left", "point", 1, false, true}},
           {120, 0, true}),
      "head: running 1:05 min, 2/2 modules up, 60 messages/s, 6 % CPU, focus track\n"
      "bids: track 0.60 *, left: point 1.00 (person)\n"
      "\n"
      "MODULE      CPU   MEMORY RESTARTS  MODE  STATUS\n"
      "module_0   3.1%  1.23 MB        0        running | ready (0 s ago)\n"
      "module_1   3.1%  1.23 MB        1  track running\n"
      "\n"
      "LINK                             1/s    B/s    AGE    p99 THROTTLED DROPPED IGNORED\n"
      "module_0.left → tcp:robot:7000    30 43.2MB 2.10ms 10.2ms         -       -   1.23k  "
      "ignored:"
      " not in focus\n"
      "module_1.left → tcp:robot:7000    30 43.2MB 2.10ms 10.2ms         2       1       -  at "
      "most "
      "30/s, 2 throttled, 1 dropp…\n");
}

TEST(Screen, LinesAreWholeWhereThereIsNoWidth) {
  auto state = some_state(1);
  state.modules[0].last_line = std::string(500, 'x');
  const auto text = draw(state, {}, {std::numeric_limits<std::size_t>::max(), 0, true});
  EXPECT_NE(text.find(std::string(500, 'x') + " (0 s ago)\n"), std::string::npos) << text;
}

TEST(Screen, ShowsTheModeOfWhoContributesToTheTaskInFocus) {
  auto state = some_state(3);
  state.links.clear();
  auto link = [&](const std::string& from, const std::string& to) {
    state.links.emplace_back().from = from;
    state.links.back().to = to;
  };
  link("module_0.out", "module_1.in");  // the task
  link("module_1.out", "module_2.in");
  const auto text = draw(state, {}, {120, 0, true});
  EXPECT_NE(text.find("module_0   3.1%  1.23 MB        0  (track) running\n"), std::string::npos)
      << text;
  EXPECT_NE(text.find("module_1   3.1%  1.23 MB        1  track   running\n"), std::string::npos);
  EXPECT_NE(text.find("module_2   3.1%  1.23 MB        2          idle"), std::string::npos);
}

TEST(Screen, IsScrolledAndHasTroubleFirst) {
  const auto state = some_state(50);
  auto some = draw(state, {}, {80, 24, true, 0});
  EXPECT_EQ(std::count(some.begin(), some.end(), '\n'), 24);
  EXPECT_NE(some.find("STATUS\nmodule_3 "), std::string::npos) << some;
  EXPECT_NE(some.find("given up: failed with status 1"), std::string::npos);
  EXPECT_NE(some.find("lines 1 to 21 of 103;"), std::string::npos) << some;
  some = draw(state, {}, {80, 24, true, 1000});
  EXPECT_NE(some.find("module_49.left → "), std::string::npos) << some;
  EXPECT_NE(some.find("lines 83 to 103 of 103;"), std::string::npos) << some;
}

TEST(Screen, FitsAnySize) {
  for (std::size_t width : {1U, 20U, 40U, 80U, 300U})
    for (std::size_t height : {1U, 2U, 5U, 6U, 100U}) {
      const auto text = draw(some_state(7), {{"", "track", 1, true, false}}, {width, height, true});
      EXPECT_LE(std::count(text.begin(), text.end(), '\n'), height);
      for (std::size_t begin = 0, end = 0; (end = text.find('\n', begin)) != std::string::npos;
           begin = end + 1) {
        const auto line = text.substr(begin, end - begin);
        EXPECT_LE(
            std::count_if(line.begin(), line.end(),
                          [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }),
            width)
            << line;
      }
    }
}

TEST(Screen, SaysWhyAModuleDoesNotWork) {
  hc::ModuleState module;
  module.status = hc::ModuleStatus::Running;
  EXPECT_FALSE(is_in_trouble(module));
  module.in_focus = false;
  EXPECT_EQ(status_text(module), "idle (not in focus)");
  module.detail = "blocked: output left waits for its reader";
  EXPECT_EQ(status_text(module), module.detail);
  EXPECT_TRUE(is_in_trouble(module));
  module.waits_for = "augment.focus";
  module.waits = 11;
  EXPECT_EQ(status_text(module), "has waited 11 s for augment.focus");
  module.waits.reset();
  module.detail = "";
  module.last_level = hc::Level::Warning;
  EXPECT_TRUE(is_in_trouble(module));
  module.last_level = hc::Level::Result;
  EXPECT_FALSE(is_in_trouble(module));
  module.status = hc::ModuleStatus::Stalled;
  module.detail = "busy";
  EXPECT_TRUE(is_in_trouble(module));
  EXPECT_EQ(status_text(module), "stalled: busy");
}

TEST(Screen, ShowsNothingThatATerminalObeys) {
  auto state = some_state(1);
  state.modules[0].last_line = "\x1b[2J\n";
  EXPECT_EQ(draw(state, {}, {120, 0, true}).find('\x1b'), std::string::npos);
}

TEST(Drawing, HasPortsRatesAndTheWorkspaceInBold) {
  auto drawing = drawing_of(some_state(2));
  EXPECT_EQ(as_text(drawing, true),
            "head, focus: track\n"
            "\nmodule_0  (3.1 %)\n  left → tcp:robot:7000  30/s\n"
            "\nmodule_1  (3.1 %)\n  left → tcp:robot:7000  30/s, keep latest, rate 30\n");
  EXPECT_NE(as_text(drawing, false).find("\x1b[1mmodule_1\x1b[0m"), std::string::npos);
}

}  // namespace
}  // namespace tool
