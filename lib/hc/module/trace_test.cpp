// SPDX-License-Identifier: Apache-2.0
// What a module reports of its messages while it is traced.
#include <unistd.h>

#include <cstdlib>
#include <filesystem>

#include <hc/contract/trace.h>
#include <hc/module/running_module_test.h>
#include <hc/testing/allocations.h>

namespace hc {
namespace {

using What = TraceEvent::What;

Message at(Message message, std::int64_t time, std::int64_t seq) {
  message.header.time = unix_time(time);
  message.header.seq = seq;
  return message;
}

/// Events in words, without their moments, which must not go back.
std::vector<std::string> words(const std::vector<TraceEvent>& events) {
  std::vector<std::string> all;
  Time moment;
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

TEST_F(RunningModule, ReportsWhenItTookHandledAndSent) {
  ManualClock clock;
  Module module{"slow", "Takes 3 ms.", {.clock = &clock}};
  auto in = module.input("in", table(), "");
  auto out = module.output("out", table(), "");
  module.on(in, [&](const Doubles& m) {
    clock.advance(std::chrono::milliseconds(3));
    out.send({m.matrix().at(0, 0)});
    clock.advance(std::chrono::milliseconds(1));
  });
  auto first = sink_of(uri("in"));
  auto trace = source_of(uri("trace")), done = source_of(uri("out"));
  ASSERT_TRUE(first->send(at(table().message({1.0}), 1000, 7)));
  ASSERT_TRUE(first->close());
  start(module, {"--in=" + uri("in"), "--out=" + uri("out"), "--out=trace=" + uri("trace")});
  const auto events = events_of(*trace);
  EXPECT_EQ(join(), 0);
  EXPECT_EQ(words(events), (std::vector<std::string>{"took in 0 7 1000", "began in 0 7 1000",
                                                     "sent out 1 0 1000", "ended in 0 7 1000"}));
  EXPECT_EQ(events[2].moment - events[1].moment, std::chrono::milliseconds(3));
  EXPECT_EQ(events[3].moment - events[2].moment, std::chrono::milliseconds(1));
}

TEST_F(RunningModule, ReportsWhatItReadFromItsClock) {
  ManualClock clock;
  clock.set_wall(unix_time(5));
  Module module{"reader", "Reads its clock.", {.clock = &clock}};
  auto in = module.input("in", table(), "");
  std::vector<Time> read;
  module.on_start([&] { read.push_back(module.now()); });
  module.on(in, [&](const Doubles&) {
    for (int i = 0; i < 2; ++i) {
      clock.advance(std::chrono::nanoseconds(3));
      read.push_back(i == 0 ? module.now() : Time(module.monotonic()));
    }
  });
  auto first = sink_of(uri("in"));
  auto trace = source_of(uri("trace"));
  ASSERT_TRUE(first->send(at(table().message({1.0}), 1000, 7)));
  ASSERT_TRUE(first->close());
  start(module, {"--in=" + uri("in"), "--out=trace=" + uri("trace")});
  const auto events = events_of(*trace);
  EXPECT_EQ(join(), 0);
  EXPECT_EQ(words(events),
            (std::vector<std::string>{"read - 0 0 0", "took in 0 7 1000", "began in 0 7 1000",
                                      "read - 0 0 0", "read - 0 0 0", "ended in 0 7 1000"}));
  EXPECT_EQ(read, (std::vector<Time>{events[0].moment, events[3].moment, unix_time(6)}));
  EXPECT_EQ(events[4].moment, unix_time(11));
}

TEST_F(RunningModule, ReportsEachMessageThatIsTakenTogether) {
  Module module{"pair", "Takes two together."};
  auto left = module.input("left", table(), ""), right = module.input("right", table(), "");
  module.on(together(left, right), [](const auto&, const auto&) {});
  auto one = sink_of(uri("left")), other = sink_of(uri("right"));
  auto trace = source_of(uri("trace"));
  ASSERT_TRUE(one->send(at(table().message({1.0}), 1000, 7)));
  ASSERT_TRUE(other->send(at(table().message({1.0}), 1000, 9)));
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
  Taker module{"sink"};
  auto sink = sink_of(uri("in"));
  auto trace = source_of(uri("trace"));
  start_managed(module, {"--in=" + uri("in")});
  EXPECT_EQ(next_links().size(), 1U);
  EXPECT_EQ(relink("link out trace=" + uri("trace"))[1], "out trace " + uri("trace"));
  ASSERT_TRUE(sink->send(at(table().message({1.0}), 1000, 7)));
  Message message = next(*trace);  // while it runs
  EXPECT_EQ(
      words(read_trace(message)),
      (std::vector<std::string>{"took in 0 7 1000", "began in 0 7 1000", "ended in 0 7 1000"}));
  EXPECT_EQ(relink("unlink out trace=" + uri("trace")).size(), 1U);
  EXPECT_FALSE(*receive(*trace, message));
  command("unlink out trace=" + uri("trace"));
  EXPECT_EQ(read_log(next(*reports_, Report::Log))->text,
            "command \"unlink out trace=" + uri("trace") + "\": there is no such link");
  ASSERT_TRUE(sink->close());
  EXPECT_EQ(join(), 0);
}

TEST_F(RunningModule, ReportsWhenAParameterWasSet) {
  Taker module{"sink"};
  module.parameter("title", "a", "", "");
  auto sink = sink_of(uri("in"));
  auto trace = source_of(uri("trace"));
  start_managed(module, {"--in=" + uri("in"), "--out=trace=" + uri("trace")});
  next(*reports_, Report::Parameters);
  command("set title=b and c");
  next(*reports_, Report::Parameters);
  ASSERT_TRUE(sink->close());
  const auto events = events_of(*trace);
  EXPECT_EQ(join(), 0);
  ASSERT_EQ(events.size(), 1U);
  EXPECT_EQ(events[0].what, What::Set);
  EXPECT_EQ(events[0].port, "title");
  EXPECT_EQ(events[0].value, "b and c");
  EXPECT_GT(events[0].moment, Time());
}

TEST_F(RunningModule, GoesOnWhenNobodyReadsItsTrace) {
  Module module{"sink", "Takes."};
  auto in = module.input("in", table(), "");
  int taken = 0;
  module.on(in, [&](const auto&) { ++taken; });
  auto sink = sink_of(uri("in"));
  auto trace = source_of(uri("trace"));
  start_managed(module, {"--in=" + uri("in"), "--out=trace=" + uri("trace")});
  EXPECT_EQ(next_links().size(), 2U);
  trace.reset();
  for (int i = 0; i < 2; ++i) {
    ASSERT_TRUE(sink->send(at(table().message({1.0}), 1000, i)));
    while (next_counters(*reports_)[0][0] <= i) {
    }
  }
  ASSERT_TRUE(sink->close());
  EXPECT_EQ(join(), 0);
  EXPECT_EQ(taken, 2);
}

/// A clock that stands still, and counts who looks at it.
class CountingClock final : public Clock {
 public:
  [[nodiscard]] MonotonicTime monotonic() const override { return MonotonicTime(kBegin); }
  [[nodiscard]] Time wall() const override {
    ++looks;
    return Time(kBegin);
  }
  mutable std::int64_t looks = 0;

 private:
  static constexpr std::chrono::nanoseconds kBegin{std::chrono::hours(1)};
};

/// What the handling of 1000 messages takes.
struct Effort {
  std::int64_t allocations = 0, looks = 0;
  std::uintmax_t traced = 0;  // written over the link for the trace [byte]
};

class TracedEffort : public RunningModule {
 protected:
  /// @param commands  are obeyed before the first message.
  Effort measure(const std::vector<std::string>& more, const std::vector<std::string>& commands) {
    CountingClock clock;
    Module module{"double", "Doubles.", {.clock = &clock}};
    auto in = module.input("in", table(), "");
    auto out = module.output("out", table(), "");
    Effort begin, end;
    int handled = 0;
    module.on(in, [&](const Doubles& message) {
      ++handled;
      if (handled == kBegin) begin = {hc::allocations.count, clock.looks, 0};
      if (handled == kEnd) end = {hc::allocations.count, clock.looks, 0};
      out.send(2 * message.numbers()[0]);
    });
    std::filesystem::remove(trace_);
    std::vector<std::string> words = {"--in=file:" + in_, "--out=out=file:" + out_};
    words.insert(words.end(), more.begin(), more.end());
    control_ = sink_of(uri("control"));
    reports_ = source_of(uri("reports"));
    for (const auto& command : commands) EXPECT_TRUE(send_command(*control_, command));
    words.insert(words.end(), {"--manage=" + uri("reports"), "--control=" + uri("control")});
    EXPECT_EQ(run(module, words), 0);
    control_.reset();
    reports_.reset();
    EXPECT_EQ(handled, kEnd + 1);
    return {end.allocations - begin.allocations, end.looks - begin.looks,
            std::filesystem::exists(trace_) ? std::filesystem::file_size(trace_) : 0};
  }

  void SetUp() override {
    auto sink = sink_of("file:" + in_);
    for (int i = 0; i < kEnd + 1; ++i) ASSERT_TRUE(sink->send(at(table().message({1.0}), 1000, i)));
    ASSERT_TRUE(sink->close());
  }
  void TearDown() override {
    for (const auto& file : {in_, out_, trace_}) std::filesystem::remove(file);
  }

  static constexpr int kBegin = 1000, kEnd = 2000;
  const std::string in_ = ::testing::TempDir() + "in_" + std::to_string(::getpid()) + ".mtp",
                    out_ = in_ + ".out.mtp", trace_ = in_ + ".trace.mtp";
};

TEST_F(TracedEffort, IsNoneWhileTheTraceIsNotLinked) {
  const std::string trace = "trace=file:" + trace_;
  measure({}, {});  // what is allocated once
  const auto never = measure({}, {});
  const auto before = measure({}, {"link out " + trace, "unlink out " + trace});
  const auto traced = measure({"--out=" + trace}, {});
  constexpr std::int64_t kOther = 5;  // buffers that the file is read into
  EXPECT_LE(std::abs(never.allocations - before.allocations), kOther);
  EXPECT_EQ(never.looks, before.looks);
  EXPECT_EQ(never.traced, 0U);
  EXPECT_EQ(before.traced, 0U);
#if !__has_feature(thread_sanitizer)
  EXPECT_GT(traced.allocations, never.allocations + 10 * kOther);
#endif
  EXPECT_GE(traced.looks, never.looks + 3 * 1000);
  EXPECT_GT(traced.traced, 0U);
}

}  // namespace
}  // namespace hc
