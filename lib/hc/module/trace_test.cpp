// SPDX-License-Identifier: Apache-2.0
// What a module reports of its messages while it is traced.
#include <hc/contract/trace.h>
#include <hc/module/running_module_test.h>

namespace hc {
namespace {

using What = TraceEvent::What;

Message at(Message message, std::int64_t time, std::int64_t seq) {
  message.header.time = time;
  message.header.seq = seq;
  return message;
}

/// Events in words, without their moments, which must not go back.
std::vector<std::string> words(const std::vector<TraceEvent>& events) {
  std::vector<std::string> all;
  std::int64_t moment = 0;
  for (const auto& event : events) {
    EXPECT_GE(event.moment, std::exchange(moment, event.moment));
    const auto row = rows_of(make_trace(std::span(&event, 1)))[0];
    all.push_back(row.substr(0, row.rfind(' ')));
  }
  return all;
}

/// The events of a module that has ended.
std::vector<TraceEvent> events_of(Source& trace) {
  std::vector<TraceEvent> all;
  Message message;
  while (*receive(trace, message)) {
    const auto events = read_trace(message);
    all.insert(all.end(), events.begin(), events.end());
  }
  return all;
}

TEST_F(RunningModule, TellsWhenItTookHandledAndSent) {
  ManualClock clock;
  Module module{"slow", "Takes 3 ms.", clock};
  auto in = module.input("in", table<double>(), "");
  auto out = module.output("out", table<double>(), "");
  module.on(in, [&](const Doubles& m) {
    clock.advance(std::chrono::milliseconds(3));
    out.send(table({m.matrix().at(0, 0)}));
    clock.advance(std::chrono::milliseconds(1));
  });
  auto first = sink_of(uri("in"));
  auto trace = source_of(uri("trace")), done = source_of(uri("out"));
  ASSERT_TRUE(first->send(at(table({1.0}), 1000, 7)));
  ASSERT_TRUE(first->close());
  start(module, {"--in=" + uri("in"), "--out=" + uri("out"), "--out=trace=" + uri("trace")});
  const auto events = events_of(*trace);
  EXPECT_EQ(join(), 0);
  EXPECT_EQ(words(events), (std::vector<std::string>{"took in 0 7 1000", "began in 0 7 1000",
                                                     "sent out 1 0 1000", "ended in 0 7 1000"}));
  EXPECT_EQ(events[2].moment - events[1].moment, 3'000'000);
  EXPECT_EQ(events[3].moment - events[2].moment, 1'000'000);
}

TEST_F(RunningModule, TellsOfEachMessageThatIsTakenTogether) {
  Module module{"pair", "Takes two together."};
  auto left = module.input("left", table<double>(), ""),
       right = module.input("right", table<double>(), "");
  module.on(together(left, right), [](const auto&, const auto&) {});
  auto one = sink_of(uri("left")), other = sink_of(uri("right"));
  auto trace = source_of(uri("trace"));
  ASSERT_TRUE(one->send(at(table({1.0}), 1000, 7)));
  ASSERT_TRUE(other->send(at(table({1.0}), 1000, 9)));
  ASSERT_TRUE(one->close());
  ASSERT_TRUE(other->close());
  start(module,
        {"--in=left=" + uri("left"), "--in=right=" + uri("right"), "--out=trace=" + uri("trace")});
  EXPECT_EQ(words(events_of(*trace)),
            (std::vector<std::string>{"took left 0 7 1000", "took right 0 9 1000",
                                      "began left 0 7 1000", "began right 0 9 1000",
                                      "ended left 0 7 1000", "ended right 0 9 1000"}));
  EXPECT_EQ(join(), 0);
}

TEST_F(RunningModule, IsTracedFromACommandOn) {
  Module module{"sink", "Takes."};
  auto in = module.input("in", table<double>(), "");
  module.on(in, [](const auto&) {});
  auto sink = sink_of(uri("in"));
  auto trace = source_of(uri("trace"));
  start_managed(module, {"--in=" + uri("in")});
  EXPECT_EQ(rows_of(next(*reports_, Report::Links)).size(), 1U);
  ASSERT_TRUE(tell(*control_, "link out trace=" + uri("trace")));
  EXPECT_EQ(rows_of(next(*reports_, Report::Links))[1], "out trace " + uri("trace"));
  ASSERT_TRUE(sink->send(at(table({1.0}), 1000, 7)));
  Message message;
  ASSERT_TRUE(*receive(*trace, message));  // while it runs
  EXPECT_EQ(
      words(read_trace(message)),
      (std::vector<std::string>{"took in 0 7 1000", "began in 0 7 1000", "ended in 0 7 1000"}));
  ASSERT_TRUE(tell(*control_, "unlink out trace=" + uri("trace")));
  EXPECT_EQ(rows_of(next(*reports_, Report::Links)).size(), 1U);
  EXPECT_FALSE(*receive(*trace, message));
  ASSERT_TRUE(tell(*control_, "unlink out trace=" + uri("trace")));
  EXPECT_EQ(rows_of(next(*reports_, Report::Refusal))[0],
            "command \"unlink out trace=" + uri("trace") + "\": there is no such link");
  ASSERT_TRUE(sink->close());
  EXPECT_EQ(join(), 0);
}

TEST_F(RunningModule, GoesOnWhenNobodyReadsItsTrace) {
  Module module{"sink", "Takes."};
  auto in = module.input("in", table<double>(), "");
  int taken = 0;
  module.on(in, [&](const auto&) { ++taken; });
  auto sink = sink_of(uri("in"));
  auto trace = source_of(uri("trace"));
  start_managed(module, {"--in=" + uri("in"), "--out=trace=" + uri("trace")});
  EXPECT_EQ(rows_of(next(*reports_, Report::Links)).size(), 2U);
  trace.reset();
  for (int i = 0; i < 2; ++i) {
    ASSERT_TRUE(sink->send(at(table({1.0}), 1000, i)));
    while (next_counters(*reports_)[0][0] <= i) {
    }
  }
  ASSERT_TRUE(sink->close());
  EXPECT_EQ(join(), 0);
  EXPECT_EQ(taken, 2);
}

}  // namespace
}  // namespace hc
