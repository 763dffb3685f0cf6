// SPDX-License-Identifier: Apache-2.0
// Commands to a running graph.
#include <graph/run/live_change_test.h>

#include <atomic>

namespace hc {
namespace {

TEST_F(LiveChange, WrongCommandsAreAnsweredAndChangeNothing) {
  add("camera").known = rate();
  beside([&] {
    EXPECT_EQ(ask({"remov camera"}), Lines{"no command \"remov\", did you mean \"remove\"?"});
    EXPECT_EQ(ask({"stop it", "restart camra"}), (Lines{"usage: stop", "no module \"camra\""}));
    EXPECT_EQ(ask({}), Lines{"there is no command"});
    EXPECT_EQ(ask({"remove camera"}), (Lines{"one problem", "another"}));
    EXPECT_EQ(ask({"remove camra"}), Lines{"no module \"camra\", did you mean \"camera\"?"});
    EXPECT_EQ(ask({"set camera.rat=3"}),
              Lines{"module camera has no parameter \"rat\", did you mean \"rate\"?"});
    EXPECT_EQ(ask({"set camera.rate=3", "set camera.rate=x"}),
              Lines{"module camera: parameter rate: \"x\" is not a number"});
    plan_next(plan_);
    EXPECT_EQ(ask({"add more camera"}), Lines{"ok"});
    EXPECT_FALSE(was_reloaded());
  });
  auto report = run();
  ASSERT_TRUE(report) << report.error().detail;
  EXPECT_EQ(count("camera: started"), 1);
}

TEST_F(LiveChange, TheGraphGoesOnWhileAChangeIsPlanned) {
  add("a");
  const auto again = must(Event::make());
  std::atomic<int> plans = 0;
  plans_ = [&](int) {
    if (++plans == 1) await(again.descriptor());
  };
  on_line_ = [&](std::string_view) {
    if (count("a: started") == 2) again.raise();
  };
  beside([&] {
    plan_next(plan_);
    std::thread slow([&] { EXPECT_EQ(ask({"add b p"}, "slow"), Lines{"ok"}); });
    std::thread next([&] { EXPECT_EQ(ask({"add c p", "restart a"}, "next"), Lines{"ok"}); });
    EXPECT_EQ(ask({"restart a"}), Lines{"ok"});
    slow.join();
    next.join();
    EXPECT_EQ(plans, 2);
  });
  ASSERT_TRUE(run());
}

TEST_F(LiveChange, AGraphEndsAtOnceWhileAChangeIsPlanned) {
  add("a");
  plans_ = [&](int stop) {
    Run::stop();
    await(stop);
  };
  thread_ = std::thread([&] { EXPECT_EQ(ask({"add b p"}), Lines{"the graph is stopping"}); });
  auto report = must(run());
  EXPECT_TRUE(report.stopped);
}

TEST_F(LiveChange, ModulesComeAndGo) {
  add("stays");
  add("comes");
  Plan other = plan_;
  plan_.modules.pop_back();
  add("goes");
  stop_at("goes: started", 2);
  thread_ = std::thread([&] {
    plan_next(other);
    EXPECT_EQ(ask({"remove goes", "add comes program"}), Lines{"ok"});
    plan_next(plan_);
    EXPECT_EQ(ask({"add goes program"}), Lines{"ok"}) << "while it may be stopping still";
  });
  auto report = must(run());
  EXPECT_EQ(count("stays: started"), 1);
  EXPECT_EQ(count("comes: started"), 1);
  EXPECT_EQ(count("goes: started"), 2);
  ASSERT_EQ(report.state.modules.size(), 2U);
  EXPECT_EQ(report.state.modules[1].name, "goes");
}

TEST_F(LiveChange, AnotherProgramIsStartedInThePlaceOfTheFirst) {
  add("a");
  stop_at("a: other");
  thread_ = std::thread([&] {
    Plan other = plan_;
    other.modules[0].options = {"-c", "echo other >&2; exec sleep 1000"};
    plan_next(other);
    EXPECT_EQ(ask({"add b p"}), Lines{"ok"});
  });
  ASSERT_TRUE(run());
  EXPECT_EQ(count("a: started"), 2);
}

TEST_F(LiveChange, AParameterIsSetWithoutPlanning) {
  auto& a = add("a");
  a.known = rate();
  a.known.emplace("fixed", a.known.at("rate")).first->second.options.fixed = true;
  plans_ = [](int) { HC_CHECK(false, "planned"); };
  stop_at("a: started", 2);
  thread_ = std::thread([&] {
    EXPECT_EQ(ask({"set a.rate=3"}), Lines{"ok"});
    EXPECT_EQ(ask({"set a.fixed=3"}),
              (Lines{"ok", "restarting a, since fixed is fixed while it runs"}));
  });
  auto report = must(run());
  EXPECT_EQ(report.state.modules[0].parameters,
            (std::map<std::string, std::string>{{"fixed", "3"}, {"rate", "3"}}));
}

TEST_F(LiveChange, StopIsACommand) {
  add("a");
  thread_ = std::thread([&] { EXPECT_EQ(ask({"stop"}), Lines{"ok"}); });
  auto report = must(run());
  EXPECT_TRUE(report.stopped);
}

TEST_F(LiveChange, WhoHasEndedRestsUntilThereIsMoreToRead) {
  auto& reader = add("reader", "exit 0");
  reader.ends = {{true, "in", "unix:@one?wait=1", ""}, {true, "in", "unix:@two?wait=1", ""}};
  add("stays");
  on_line_ = [this](std::string_view line) {
    if (line != "reader: ended" || thread_.joinable()) return;
    thread_ = std::thread([this] {
      Plan other = plan_;
      other.modules[0].ends.pop_back();
      change_to(other);
      other.modules[0].ends.push_back({true, "in", "unix:@three?wait=1", ""});
      plan_next(other);
      EXPECT_EQ(ask({"link x.out reader.in"}), Lines{"ok"});
      stop();
    });
  };
  ASSERT_TRUE(run());
  EXPECT_EQ(count("reader: started"), 2);
}

TEST_F(LiveChange, TheStateIsPublishedAsJson) {
  add("camera").mode = "track";
  plan_.modes = {{"track", 1}};
  std::string text, line;
  beside([&] {
    auto graph =
        open_source({"unix", "@hypercolumn.live." + std::to_string(::getpid()), {{"wait", "60"}}});
    ASSERT_TRUE(graph);
    Message message;
    ASSERT_TRUE(receive(**graph, message));
    EXPECT_EQ(message.header.src, 1);
    text = rows_of(message).at(0);
    EXPECT_EQ(ask({"restart camera"}), Lines{"ok"});
    while (message.header.src != 2) ASSERT_TRUE(receive(**graph, message));
    line = rows_of(message).at(0);
  });
  ASSERT_TRUE(run());
  for (const char* part : {"{\"graph\":\"live\"", "\"name\":\"camera\"", "\"status\":\"starting\"",
                           "\"mode\":\"track\"", "\"modes\":{\"track\":1}", "\"focus\":{}"})
    EXPECT_NE(text.find(part), std::string::npos) << part << " in " << text;
  EXPECT_TRUE(line.starts_with("{\"module\":\"camera\",\"level\":")) << line;
}

}  // namespace
}  // namespace hc
