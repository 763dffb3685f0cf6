// SPDX-License-Identifier: Apache-2.0
// A module by the clock of its messages: --clock messages.
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <hc/contract/trace.h>
#include <hc/module/arguments.h>
#include <hc/module/running_module_test.h>

namespace hc {
namespace {

using namespace std::chrono_literals;
using Log = std::vector<std::string>;

constexpr Time kFirst(1'700'000'000s);

/// A message so many milliseconds behind kFirst.
Message at(std::int64_t milliseconds, std::int32_t mode = 0) {
  auto message = table().message({static_cast<double>(milliseconds)});
  message.header.time = kFirst + milliseconds * 1ms;
  message.header.mode = mode;
  return message;
}
Message focus(std::int64_t milliseconds, std::int32_t mode) {
  auto message = table<std::int32_t>().message({mode});
  message.header.time = at(milliseconds).header.time;
  return message;
}
Message without_time() {
  return table().message({-1.0});
}

class ByMessages : public RunningModule {
 protected:
  ByMessages() {
    module.on(a, [this](const auto& message) { note("a", message); });
    module.on(b, [this](const auto& message) { note("b", message); });
  }
  /// "a 5 at 7": the number of a message, and what the clock says in milliseconds.
  void note(const std::string& what, const Doubles& message) {
    log.push_back(what + " " + std::to_string(std::llround(message.matrix().numbers()[0])) + now());
  }
  std::string now() {
    EXPECT_EQ(Time(module.monotonic()), module.now());
    return " at " + std::to_string((module.now() - kFirst) / 1ms);
  }
  /// Has the clock be that of a trace.
  void follow(const std::vector<TraceEvent>& events) {
    auto trace = sink_of(uri("clock"));
    ASSERT_TRUE(trace->send(make_trace(events)));
    ASSERT_TRUE(trace->close());
    sinks.push_back(std::move(trace));
    words[1] = uri("clock");
  }
  /// @param input  with a word behind it: by another link.
  void feed(const std::string& input, const std::vector<Message>& messages) {
    words.insert(words.end(), {"--in", input.substr(0, input.find(' ')) + "=" + uri(input)});
    auto sink = sink_of(uri(input));
    for (const auto& message : messages) ASSERT_TRUE(sink->send(message));
    ASSERT_TRUE(sink->close());
    sinks.push_back(std::move(sink));
  }
  Log run() {
    start(module, words);
    EXPECT_EQ(join(), 0);
    return log;
  }

  Module module{"clocked", "Notes what comes when."};
  Input<Kind<MatrixType::Table, double>> a = module.input("a", table(), "");
  Input<Kind<MatrixType::Table, double>> b = module.input("b", table(), "");
  std::vector<std::string> words{"--clock", "messages"};
  std::vector<std::unique_ptr<Sink>> sinks;
  Log log;
};

TEST_F(ByMessages, MessagesOfAllLinksComeInTheOrderOfTheirTimes) {
  feed("a", {at(1), at(3), at(8), at(9)});
  feed("b", {at(0), at(3), at(4)});
  EXPECT_EQ(run(), Log({"b 0 at 0", "a 1 at 1", "a 3 at 3", "b 3 at 3", "b 4 at 4", "a 8 at 8",
                        "a 9 at 9"}));
}

TEST_F(ByMessages, TheClockNeverGoesBack) {
  feed("a", {at(5), at(2), without_time(), at(9)});
  feed("b", {at(6)});
  EXPECT_EQ(run(), Log({"a 5 at 5", "a 2 at 5", "a -1 at 5", "b 6 at 6", "a 9 at 9"}));
}

TEST_F(ByMessages, WhatIsDoneAgainAndAgainIsDoneBetweenMessages) {
  feed("a", {at(10), at(30), at(31)});
  feed("b", {at(27)});
  module.on_start([&] { log.push_back("start" + now()); });
  module.on_end([&] { log.push_back("end" + now()); });
  module.every(10ms, [&] { log.push_back("ten" + now()); });
  module.every(7ms, [&] { log.push_back("seven" + now()); });
  EXPECT_EQ(run(), Log({"start at 10", "a 10 at 10", "seven at 17", "ten at 20", "seven at 24",
                        "b 27 at 27", "ten at 30", "a 30 at 30", "seven at 31", "a 31 at 31",
                        "end at 31"}));
}

TEST_F(ByMessages, ALongGapIsPassedAtOnce) {
  const std::int64_t year = 365LL * 86400 * 1000;
  feed("a", {at(0), at(year), at(year + 2)});
  int fired = 0;
  module.every(1ms, [&] { ++fired; });
  run();
  EXPECT_EQ(fired, 4);  // the one that was missed last, and three
  EXPECT_EQ(log.size(), 3U);
}

TEST_F(ByMessages, AGeneratorKeepsItsRateByThem) {
  feed("a", {at(0), at(15), at(18), at(40)});
  module.generate([&] {
    module.keep_rate(100);
    log.push_back("look" + now());
  });
  EXPECT_EQ(run(), Log({"a 0 at 0", "look at 0", "look at 10", "look at 20", "a 15 at 20",
                        "a 18 at 20", "look at 30", "look at 40", "a 40 at 40", "look at 50"}));
}

TEST_F(ByMessages, AGeneratorWaitsUntilATimeOfThem) {
  feed("a", {at(0), at(15), at(18), at(40)});
  std::optional<MonotonicTime> begin;
  module.generate([&] {
    if (!begin) begin = module.monotonic();
    module.wait_until(*begin + 30ms);
    log.push_back("look" + now());
  });
  const auto all = run();
  // Once it has waited, it is called between messages.
  ASSERT_GE(all.size(), 2U);
  EXPECT_EQ(all[0], "a 0 at 0");
  EXPECT_EQ(all[1], "look at 30");
}

TEST_F(ByMessages, AGeneratorThatKeepsNoRateIsCalledBetweenMessages) {
  feed("a", {at(1), at(2)});
  module.generate([&] { log.push_back("look" + now()); });
  EXPECT_EQ(run(), Log({"a 1 at 1", "look at 1", "a 2 at 2", "look at 2"}));
}

TEST_F(ByMessages, AGeneratorsEndIsTheModules) {
  feed("a", {at(1), at(2), at(3)});
  module.generate([&] {
    if (module.now() >= at(2).header.time) module.stop();
  });
  EXPECT_EQ(run(), Log({"a 1 at 1", "a 2 at 2"}));
}

TEST_F(ByMessages, WhatHasNoTimeIsOfNow) {
  feed("a", {at(3)});
  module.generate([&] {
    log.push_back("look");
    EXPECT_EQ(module.time_of({}), module.now());
    EXPECT_EQ(module.time_of(at(2).header), at(2).header.time);
  });
  EXPECT_EQ(run(), Log({"a 3 at 3", "look"}));
}

TEST_F(ByMessages, TheFocusIsHeardInItsTime) {
  feed("a", {at(1, 4), at(5, 4), at(9, 4)});
  feed("focus", {focus(3, 4), focus(7, 2), focus(20, 4)});
  words.insert(words.end(), {"--exclusive", "a"});
  EXPECT_EQ(run(), Log({"a 5 at 5"}));
}

TEST_F(ByMessages, AFocusExpiresInTheirTime) {
  feed("a", {at(1, 4), at(121, 4), at(122, 4), at(303, 4)});
  feed("focus", {focus(1, 4), focus(300, 4)});
  words.insert(words.end(), {"--exclusive", "a"});
  EXPECT_EQ(run(), Log({"a 1 at 1", "a 121 at 121", "a 303 at 303"}));
}

TEST_F(ByMessages, ATraceSaysWhenEachMessageAndTimerComes) {
  using enum TraceEvent::What;
  auto moment = [](std::int64_t milliseconds) { return at(milliseconds).header.time; };
  feed("a", {at(1, 4), at(2, 4)});
  feed("a again", {at(3, 4)});
  feed("focus", {table<std::int32_t>().message({4})});
  module.every(1s, [&] { log.push_back("timer" + now()); });
  module.every(1s, [&] { log.push_back("other timer" + now()); });
  auto timeout = module.after(1s, [&] { log.push_back("timeout" + now()); });
  module.on_start([&] { log.push_back("start" + now()); });
  const std::vector<TraceEvent> events = {
      {Took, "", 0, 0, Time(), moment(5)},          {Began, "", 0, 0, Time(), moment(6), 1},
      {Began, "focus", 0, 0, Time(), moment(10)},   {Began, "a", 0, 0, Time(), moment(11), 1},
      {Began, "", 0, 0, Time(), moment(12), 2},     {Began, "a", 0, 0, Time(), moment(13)},
      {Began, "", 0, 0, Time(), moment(14), 0},     {Began, "", 0, 0, Time(), moment(15), 7},
      {Began, "a", 0, 0, Time(), moment(10 + 121)},
  };
  follow(events);
  words.insert(words.end(), {"--exclusive", "a"});
  // The last one was out of focus by then.
  EXPECT_EQ(run(), Log({"start at 5", "other timer at 6", "a 3 at 11", "timeout at 12", "a 1 at 13",
                        "timer at 14"}));
}

TEST_F(ByMessages, ATraceSaysWhatIsReadFromTheClock) {
  using enum TraceEvent::What;
  feed("a", {at(1), at(2), at(3)});
  const auto moment = [](std::int64_t milliseconds) { return at(milliseconds).header.time; };
  module.on_start([&] { log.push_back("start" + now()); });
  module.on(b, [](const auto&) {});
  module.every(1h, [&] { log.push_back("timer" + now()); });
  const auto read = [&](std::int64_t at) { return TraceEvent{Read, "", 0, 0, Time(), moment(at)}; };
  const auto began = [&](const char* port, std::int64_t at) {
    return TraceEvent{Began, port, 0, 0, Time(), moment(at)};
  };
  // now() reads it three times; of the second message once more, and of the third less often.
  follow({{Took, "a", 0, 1, Time(), moment(4)},
          read(5),
          read(5),
          read(6),
          began("a", 7),
          read(8),
          read(8),
          {Sent, "x", 0, 0, Time(), moment(8)},
          read(9),
          began("a", 10),
          read(11),
          read(11),
          read(12),
          read(20),
          began("a", 13),
          read(22),
          began("", 30),
          read(31),
          read(31),
          read(32)});
  EXPECT_EQ(run(), Log({"start at 6", "a 1 at 9", "a 2 at 12", "a 3 at 22", "timer at 32"}));
}

TEST_F(ByMessages, ATraceSaysWhenAParameterIsSet) {
  using enum TraceEvent::What;
  const auto factor = module.parameter("factor", 2.0, "", "", {.max = 9});
  module.on(a, [&](const auto& message) { note(std::to_string(std::llround(*factor)), message); });
  feed("a", {at(1), at(2), at(3)});
  auto event = [](TraceEvent::What what, std::string port, std::int64_t milliseconds,
                  std::string value = {}) {
    return TraceEvent{what, std::move(port), 0, 0, Time(), at(milliseconds).header.time,
                      0,    std::move(value)};
  };
  follow({event(Began, "a", 1), event(Set, "factor", 2, "5"), event(Began, "a", 2),
          event(Set, "factor", 3, "10"), event(Set, "nosuch", 3, "1"), event(Began, "a", 4)});
  EXPECT_EQ(run(), Log({"2 1 at 1", "5 2 at 2", "5 3 at 4"}));
}

TEST_F(ByMessages, ATraceSaysWhenAGeneratorIsCalledAndHasTheFocus) {
  feed("focus", {table<std::int32_t>().message({4})});
  const std::vector<TraceEvent> events = {
      {TraceEvent::What::Began, "", 0, 0, Time(), at(3).header.time, TraceEvent::kGenerator},
      {TraceEvent::What::Began, "focus", 0, 0, Time(), at(4).header.time},
      {TraceEvent::What::Began, "", 0, 0, Time(), at(9).header.time, TraceEvent::kGenerator},
      {TraceEvent::What::Began, "", 0, 0, Time(), at(12).header.time, TraceEvent::kGenerator}};
  follow(events);
  module.generate([&] {
    module.keep_rate(1);
    log.push_back("look in " + std::to_string(module.focus()) + now());
    if (log.size() >= 2) module.stop();
  });
  EXPECT_EQ(run(), Log({"look in 4 at 4", "look in 4 at 1004"}));
}

TEST_F(ByMessages, TheLatestTimeOverflowsNoTimer) {
  auto last = at(1);
  last.header.time = Time::max();
  feed("a", {last, last});
  module.every(10ms, [&] { module.keep_rate(0); });
  int timeouts = 0;
  auto timeout = module.after(1h, [&] { ++timeouts; });
  module.on_start([&] { timeout.restart(); });
  std::vector<Time> times;
  module.on(a, [&](const auto& message) { times.push_back(message.header.time); });
  EXPECT_EQ(run(), Log());
  EXPECT_EQ(times, std::vector(2, Time::max()));
}

TEST_F(ByMessages, WhoIsBehindIsWaitedFor) {
  reports_ = source_of(uri("reports"));
  auto ahead = sink_of(uri("a")), behind = sink_of(uri("b"));
  start(module, {"--clock=messages", "--in=a=" + uri("a"), "--in=b=" + uri("b"),
                 "--manage=" + uri("reports")});
  ASSERT_TRUE(behind->send(at(0)));
  ASSERT_TRUE(ahead->send(at(2)));
  // Until the module has it, and could handle it.
  CounterRows rows;
  do {
    rows = next_counters(*reports_);
  } while (rows[0][0] == 0);
  ASSERT_TRUE(behind->send(at(1)));
  ASSERT_TRUE(ahead->close());
  ASSERT_TRUE(behind->close());
  EXPECT_EQ(join(), 0);
  EXPECT_EQ(log, Log({"b 0 at 0", "b 1 at 1", "a 2 at 2"}));
}

TEST_F(ByMessages, AClockThatThereIsNotIsRefused) {
  auto refused = [](Module& wrong, const std::string& clock) {
    auto arguments = internal::parse_arguments(wrong, {"--clock", clock});
    return arguments ? "" : arguments.error().text();
  };
  EXPECT_EQ(refused(module, "sun"),
            "Invalid: --clock is machine, messages or the URI of a trace, not \"sun\"");
  EXPECT_EQ(refused(module, "machine"), "");
  Module source{"source", "Has no inputs."};
  EXPECT_EQ(refused(source, "messages"),
            "Invalid: --clock messages needs inputs, and this module has none");
}

}  // namespace
}  // namespace hc
