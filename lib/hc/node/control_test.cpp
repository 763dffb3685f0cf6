// SPDX-License-Identifier: Apache-2.0
// What a module is told while it runs, and what it reports: commands, modes, routes, timers.
#include <gtest/gtest.h>

#include <functional>
#include <map>
#include <thread>

#include <hc/compress/compress.h>
#include <hc/node/management.h>
#include <hc/node/module.h>
#include <hc/wire/rows.h>

namespace hc {
namespace {

std::unique_ptr<Source> source_of(const std::string& uri) {
  auto source = open_source(*parse_uri(uri));
  EXPECT_TRUE(source) << uri;
  return std::move(*source);
}
std::unique_ptr<Sink> sink_of(const std::string& uri) {
  auto sink = open_sink(*parse_uri(uri));
  EXPECT_TRUE(sink) << uri;
  return std::move(*sink);
}

Message in_mode(Message message, std::int32_t mode) {
  message.header.mode = mode;
  return message;
}
Message to(Message message, std::int32_t dst) {
  message.header.dst = dst;
  return message;
}

/// A module that runs on a thread of its own, with links inside the process whose names begin with
/// the test's.
class RunningModule : public ::testing::Test {
 protected:
  std::string uri(const std::string& name) {
    return std::string("inproc:") +
           ::testing::UnitTest::GetInstance()->current_test_info()->name() + "-" + name;
  }
  void start(Module& module, std::vector<std::string> words) {
    thread_ = std::thread([this, &module, words = std::move(words)]() mutable {
      words.insert(words.begin(), "module");
      std::vector<char*> arguments;
      for (auto& word : words) arguments.push_back(word.data());
      status_ = module.run(static_cast<int>(arguments.size()), arguments.data());
    });
  }
  int join() {
    thread_.join();
    return status_;
  }

  std::thread thread_;
  int status_ = -1;
};

/// The next report of a kind.
Message next(Source& reports, internal::Report kind) {
  Message message;
  do {
    HC_CHECK(*receive(reports, message));
  } while (message.header.src != static_cast<int>(kind));
  return message;
}

Status tell(Sink& control, const std::string& line) {
  return control.send(make_rows(std::vector<std::string>{line}));
}

using Doubles = MessageOf<Kind<MatrixType::Table, double>>;

TEST_F(RunningModule, SaysWhatItIsLinkedToAndHowItIsSet) {
  Module module{"gauge", "Multiplies."};
  auto in = module.input("in", table<double>(), "");
  auto out = module.output("out", table<double>(), "");
  module.parameter("factor", 2.0, "", "");
  module.parameter("title", "a b", "", "", {.fixed = true});
  module.on(in, [](const auto&) {});
  auto sink = sink_of(uri("in"));
  auto reports = source_of(uri("reports"));
  start(module, {"--in=" + uri("in"), "--out=" + uri("out"), "--manage=" + uri("reports"),
                 "--mode=3", "--factor=4"});
  EXPECT_EQ(rows_of(next(*reports, internal::Report::Links)),
            (std::vector<std::string>{"in in " + uri("in"), "out out " + uri("out")}));
  EXPECT_EQ(rows_of(next(*reports, internal::Report::Parameters)),
            (std::vector<std::string>{"factor=4", "title=a b"}));
  auto state = next(*reports, internal::Report::State);
  auto numbers = state.view<std::int64_t>()->row(0);
  EXPECT_EQ(std::vector(numbers.begin(), numbers.end()), (std::vector<std::int64_t>{3, 0, 1}));
  ASSERT_TRUE(sink->close());
  EXPECT_EQ(join(), 0);
}

TEST_F(RunningModule, ReportsAgesAndGaps) {
  Module module{"counted", "Counts."};
  auto in = module.input("in", table<double>(), "");
  module.on(in, [](const auto&) {});
  auto sink = sink_of(uri("in"));
  auto reports = source_of(uri("reports"));
  const std::int64_t hour = 3'600'000'000'000;
  for (int i = 0; i < 3; ++i) {
    Message message = table({1.0});
    message.header.time = SystemClock().wall() - hour;
    ASSERT_TRUE(sink->send(message));
  }
  ASSERT_TRUE(sink->close());
  start(module, {"--in=" + uri("in"), "--manage=" + uri("reports")});
  EXPECT_EQ(join(), 0);
  Message message, last;
  while (*reports->take(message) == Got::Message)
    if (message.header.src == static_cast<int>(internal::Report::Counters)) last = message;
  auto row = last.view<std::int64_t>()->row(0);
  ASSERT_EQ(row.size(), 14U);
  EXPECT_EQ(row[0], 3);
  EXPECT_EQ(row[7], 0);                  // left out
  for (std::size_t i : {8U, 9U, 10U}) {  // ages
    EXPECT_GE(row[i], hour);
    EXPECT_LT(row[i], hour + hour / 7);
  }
  for (std::size_t i : {11U, 12U, 13U}) EXPECT_GE(row[i], 0);  // gaps
}

TEST_F(RunningModule, HasOnlyTheLinksThatItIsToldOf) {
  Module module{"relay", "Sends on."};
  auto in = module.input("in", table<double>(), "");
  auto out = module.output("out", table<double>(), "");
  module.on(in, [&](const Doubles& m) { out.send(table({m.matrix().at(0, 0)})); });
  auto control = sink_of(uri("control"));
  auto reports = source_of(uri("reports"));
  start(module, {"--manage=" + uri("reports"), "--control=" + uri("control")});
  // Neither standard input, which may have ended, nor standard output.
  EXPECT_TRUE(rows_of(next(*reports, internal::Report::Links)).empty());
  auto first = sink_of(uri("first"));
  auto from = source_of(uri("out"));
  ASSERT_TRUE(tell(*control, "link out out=" + uri("out")));
  ASSERT_TRUE(tell(*control, "link in in=" + uri("first")));
  ASSERT_TRUE(first->send(table({2.0})));
  Message message;
  ASSERT_TRUE(*receive(*from, message));
  EXPECT_EQ(message.view<double>()->at(0, 0), 2);
  ASSERT_TRUE(first->close());
  EXPECT_EQ(join(), 0);
}

TEST_F(RunningModule, ReportsWithoutLinksToo) {
  Module module{"idle", "Has nothing to do yet."};
  auto in = module.input("in", table<double>(), "");
  module.on(in, [](const auto&) {});
  auto control = sink_of(uri("control"));
  auto reports = source_of(uri("reports"));
  start(module, {"--manage=" + uri("reports"), "--control=" + uri("control")});
  for (int i = 0; i < 2; ++i)
    EXPECT_EQ(next(*reports, internal::Report::Counters).header.height, 0);
  ASSERT_TRUE(control->close());
  EXPECT_EQ(join(), 0);
}

TEST_F(RunningModule, ObeysCommands) {
  Module module{"gauge", "Multiplies."};
  auto in = module.input("in", table<double>(), "");
  auto out = module.output("out", table<double>(), "");
  auto factor = module.parameter("factor", 2.0, "", "", {.least = 0, .most = 10});
  auto title = module.parameter("title", "a", "", "", {.fixed = true});
  module.on(in, [&](const Doubles& m) { out.send(table({m.matrix().at(0, 0) * *factor})); });
  auto control = sink_of(uri("control"));
  auto reports = source_of(uri("reports"));
  auto first = sink_of(uri("first"));
  start(module, {"--in=" + uri("first"), "--out=" + uri("out"), "--manage=" + uri("reports"),
                 "--control=" + uri("control")});
  next(*reports, internal::Report::Parameters);
  ::testing::internal::CaptureStderr();
  ASSERT_TRUE(tell(*control, "set factor=5"));
  EXPECT_EQ(rows_of(next(*reports, internal::Report::Parameters))[0], "factor=5");
  auto from = source_of(uri("out"));
  ASSERT_TRUE(first->send(table({2.0})));
  Message message;
  ASSERT_TRUE(*receive(*from, message));
  EXPECT_EQ(message.view<double>()->at(0, 0), 10);

  auto second = sink_of(uri("second"));
  auto other = source_of(uri("other"));
  ASSERT_TRUE(tell(*control, "link in in=" + uri("second")));
  next(*reports, internal::Report::Links);
  ASSERT_TRUE(tell(*control, "link out out=" + uri("other")));
  EXPECT_EQ(rows_of(next(*reports, internal::Report::Links)).size(), 4U);
  ASSERT_TRUE(second->send(table({3.0})));
  for (auto* each : {from.get(), other.get()}) {
    ASSERT_TRUE(*receive(*each, message));
    EXPECT_EQ(message.view<double>()->at(0, 0), 15);
  }
  ASSERT_TRUE(tell(*control, "unlink in in=" + uri("first")));
  next(*reports, internal::Report::Links);
  ASSERT_TRUE(tell(*control, "unlink out out=" + uri("out")));
  EXPECT_EQ(rows_of(next(*reports, internal::Report::Links)),
            (std::vector<std::string>{"in in " + uri("second"), "out out " + uri("other")}));
  ASSERT_TRUE(second->send(table({1.0})));
  ASSERT_TRUE(*receive(*other, message));
  EXPECT_FALSE(*receive(*from, message));

  // What is wrong changes nothing, and is told.
  for (const char* line : {"set factor=-1", "set factor", "set colour=1", "set title=b", "link up",
                           "unlink out out=inproc:nowhere", "route out=x via=y", "jump"})
    ASSERT_TRUE(tell(*control, line));
  ASSERT_TRUE(tell(*control, "set factor=7"));
  EXPECT_EQ(rows_of(next(*reports, internal::Report::Parameters)),
            (std::vector<std::string>{"factor=7", "title=a"}));
  // One whose inputs have all been unlinked waits for others.
  ASSERT_TRUE(tell(*control, "unlink in in=" + uri("second")));
  next(*reports, internal::Report::Links);
  auto third = sink_of(uri("third"));
  ASSERT_TRUE(third->close());
  ASSERT_TRUE(tell(*control, "link in in=" + uri("third")));
  EXPECT_EQ(join(), 0);
  EXPECT_EQ(*title, "a");
  EXPECT_EQ(::testing::internal::GetCapturedStderr(),
            "gauge: command \"set factor=-1\": parameter factor: \"-1\" is not from 0 to 10\n"
            "gauge: command \"set factor\": no parameter \"factor\", or no value\n"
            "gauge: command \"set colour=1\": no parameter \"colour\", or no value\n"
            "gauge: command \"set title=b\": parameter title is fixed while the module runs\n"
            "gauge: command \"link up\": a command is set NAME=VALUE, link or unlink in|out "
            "PORT=URI, finish PORT=URI, route PORT=URI WORDS\n"
            "gauge: command \"unlink out out=inproc:nowhere\": there is no such link\n"
            "gauge: command \"route out=x via=y\": a route is to=ADDRESS,… and peer=NAME, not "
            "\"via\"\n"
            "gauge: command \"jump\": a command is set NAME=VALUE, link or unlink in|out "
            "PORT=URI, finish PORT=URI, route PORT=URI WORDS\n");
}

/// The numbers of the next counters; a row for each link.
std::vector<std::vector<std::int64_t>> next_counters(Source& reports) {
  std::vector<std::vector<std::int64_t>> rows;
  auto message = next(reports, internal::Report::Counters);
  auto view = *message.view<std::int64_t>();
  for (std::size_t i = 0; i < view.height(); ++i)
    rows.emplace_back(view.row(i).begin(), view.row(i).end());
  return rows;
}

TEST_F(RunningModule, ALinkThatIsMadeAnewIsOneLinkAndCountsOn) {
  Module module{"reader", "Reads."};
  auto in = module.input("in", table<double>(), "");
  auto out = module.output("out", table<double>(), "");
  module.on(in, [&](const Doubles& m) { out.send(table({m.matrix().at(0, 0)})); });
  auto control = sink_of(uri("control"));
  auto reports = source_of(uri("reports"));
  auto handled = source_of(uri("out"));
  auto other = sink_of(uri("other"));
  start(module, {"--in=" + uri("other"), "--out=" + uri("out"), "--manage=" + uri("reports"),
                 "--control=" + uri("control")});
  Message message;
  for (double i : {1, 2, 3}) {
    auto sink = open_sink(*parse_uri(uri("in")));
    while (!sink) sink = open_sink(*parse_uri(uri("in")));  // until the end before has gone
    ASSERT_TRUE(tell(*control, "link in in=" + uri("in")));
    ASSERT_TRUE((*sink)->send(table({i})));
    ASSERT_TRUE(*receive(*handled, message));
    ASSERT_TRUE((*sink)->close());
  }
  auto rows = next_counters(*reports);
  while (rows.back()[0] < 3) rows = next_counters(*reports);
  ASSERT_EQ(rows.size(), 3U) << "the other, this one, and that out";
  EXPECT_EQ(rows[1][0], 3);
  ASSERT_TRUE(tell(*control, "unlink in in=" + uri("in")));
  std::vector<std::string> links;
  while (links.size() != 2) links = rows_of(next(*reports, internal::Report::Links));
  EXPECT_EQ(links, (std::vector{"in in " + uri("other"), "out out " + uri("out")}));
  ASSERT_TRUE(other->close());
  EXPECT_EQ(join(), 0);
}

TEST_F(RunningModule, ALinkThatIsTakenAwayHasItsLastNumbersTold) {
  Module module{"relay", "Sends on."};
  auto in = module.input("in", table<double>(), "");
  auto out = module.output("out", table<double>(), "");
  module.on(in, [&](const Doubles& m) { out.send(table({m.matrix().at(0, 0)})); });
  auto sink = sink_of(uri("in")), control = sink_of(uri("control"));
  auto from = source_of(uri("out")), reports = source_of(uri("reports"));
  start(module, {"--in=" + uri("in"), "--out=" + uri("out"), "--manage=" + uri("reports"),
                 "--control=" + uri("control")});
  EXPECT_EQ(next_counters(*reports).size(), 2U);
  Message message;
  ASSERT_TRUE(sink->send(table({1.0})));
  ASSERT_TRUE(*receive(*from, message));
  for (const auto& end : {"in in=" + uri("in"), "out out=" + uri("out")}) {
    ASSERT_TRUE(tell(*control, "unlink " + end));
    EXPECT_EQ(next_counters(*reports).back()[0], 1);
    next(*reports, internal::Report::Links);
  }
  ASSERT_TRUE(control->close());
  EXPECT_EQ(join(), 0);
}

TEST_F(RunningModule, InputsThatAreTakenTogetherCanBeLinkedAnew) {
  Module module{"pair", "Adds."};
  auto left = module.input("left", table<double>(), "");
  auto right = module.input("right", table<double>(), "");
  auto out = module.output("out", table<double>(), "");
  module.on(together(left, right), [&](const Doubles& l, const Doubles& r) {
    out.send(table({l.matrix().at(0, 0) + r.matrix().at(0, 0)}));
  });
  auto control = sink_of(uri("control"));
  auto reports = source_of(uri("reports"));
  auto sums = source_of(uri("out"));
  start(module,
        {"--out=" + uri("out"), "--manage=" + uri("reports"), "--control=" + uri("control")});
  next(*reports, internal::Report::Links);
  std::string place = uri("left");
  auto l = sink_of(place), r = sink_of(uri("right"));
  auto obeyed = [&](const std::string& command) {
    ASSERT_TRUE(tell(*control, command));
    next(*reports, internal::Report::Links);
  };
  obeyed("link in right=" + uri("right"));
  obeyed("link in left=" + place);
  Message message;
  for (double i : {1, 2}) {
    ASSERT_TRUE(l->send(table({i})));
    ASSERT_TRUE(r->send(table({i})));
    ASSERT_TRUE(*receive(*sums, message));
    EXPECT_EQ(message.view<double>()->at(0, 0), 2 * i);
    obeyed("unlink in left=" + place);
    place += "_anew";
    l = sink_of(place);
    obeyed("link in left=" + place);
  }
  ASSERT_TRUE(l->close());
  EXPECT_EQ(join(), 0);
}

TEST_F(RunningModule, AFocusLinkIsTakenAwayAlone) {
  Module module{"busy", "Works."};
  auto in = module.input("in", table<double>(), "");
  module.on(in, [](const auto&) {});
  auto control = sink_of(uri("control"));
  auto reports = source_of(uri("reports"));
  auto one = sink_of(uri("one")), other = sink_of(uri("other"));
  start(module, {"--in", "focus=" + uri("one"), "--in", "focus=" + uri("other"),
                 "--manage=" + uri("reports"), "--control=" + uri("control")});
  next(*reports, internal::Report::State);
  ::testing::internal::CaptureStderr();
  ASSERT_TRUE(tell(*control, "unlink in focus=" + uri("one")));
  ASSERT_TRUE(tell(*control, "unlink in focus=" + uri("one")));
  next(*reports, internal::Report::Links);
  ASSERT_TRUE(other->send(table<std::int32_t>({7})));
  EXPECT_EQ(next(*reports, internal::Report::State).view<std::int64_t>()->at(0, 0, 1), 7);
  ASSERT_TRUE(control->close());
  EXPECT_EQ(join(), 0);
  EXPECT_EQ(::testing::internal::GetCapturedStderr(),
            "busy: command \"unlink in focus=" + uri("one") + "\": there is no such link\n");
}

TEST_F(RunningModule, AnExclusiveInputTakesTheModeInFocus) {
  Module module{"actor", "Acts."};
  auto in = module.input("command", table<double>(), "");
  auto out = module.output("done", table<double>(), "");
  module.actor(in);
  module.on(in, [&](const Doubles& m) { out.send(table({m.matrix().at(0, 0)})); });
  auto commands = sink_of(uri("in")), focus = sink_of(uri("focus"));
  auto done = source_of(uri("out"));
  auto reports = source_of(uri("reports"));
  start(module, {"--in=" + uri("in"), "--in", "focus=" + uri("focus"), "--out=" + uri("out"),
                 "--exclusive=command", "--manage=" + uri("reports")});
  auto set_focus = [&](std::int32_t mode) {
    ASSERT_TRUE(focus->send(table<std::int32_t>({mode})));
    while (next(*reports, internal::Report::State).view<std::int64_t>()->at(0, 0, 1) != mode) {
    }
  };
  set_focus(2);
  ASSERT_TRUE(commands->send(in_mode(table({1.0}), 1)));
  ASSERT_TRUE(commands->send(in_mode(table({2.0}), 2)));
  Message message;
  ASSERT_TRUE(*receive(*done, message));
  EXPECT_EQ(message.view<double>()->at(0, 0), 2);
  EXPECT_EQ(message.header.mode, 2);
  set_focus(1);
  ASSERT_TRUE(commands->send(in_mode(table({3.0}), 2)));
  ASSERT_TRUE(commands->send(in_mode(table({4.0}), 1)));
  ASSERT_TRUE(*receive(*done, message));
  EXPECT_EQ(message.view<double>()->at(0, 0), 4);
  set_focus(0);  // nobody
  ASSERT_TRUE(commands->send(in_mode(table({5.0}), 0)));
  ASSERT_TRUE(commands->send(in_mode(table({6.0}), 1)));
  ASSERT_TRUE(commands->close());
  EXPECT_EQ(join(), 0);
  EXPECT_FALSE(*receive(*done, message));
  Message counters;
  while (*reports->take(message) == Got::Message)
    if (message.header.src == static_cast<int>(internal::Report::Counters)) counters = message;
  EXPECT_EQ(counters.view<std::int64_t>()->at(0, 0, 7), 4);
}

TEST_F(RunningModule, DoesLessWhileAnotherModeHasTheFocus) {
  Module module{"busy", "Works."};
  auto in = module.input("in", table<double>(), "");
  int handled = 0;
  module.on(in, [&](const auto&) { ++handled; });
  auto sink = sink_of(uri("in")), focus = sink_of(uri("focus"));
  ASSERT_TRUE(focus->send(table<std::int32_t>({2})));
  for (int i = 0; i < 20; ++i) ASSERT_TRUE(sink->send(table({1.0})));
  ASSERT_TRUE(sink->close());
  start(module,
        {"--in=" + uri("in"), "--in", "focus=" + uri("focus"), "--modes=1,3", "--idle-rate=0.001"});
  EXPECT_EQ(join(), 0);
  EXPECT_EQ(handled, 1);
}

TEST_F(RunningModule, AGeneratorIsSlowWhileIdleAndQuickAgainAtOnce) {
  Module module{"source", "Makes numbers."};
  auto out = module.output("out", table<double>(), "");
  int made = 0;
  module.generate([&] {
    module.keep_rate(1000);
    out.send(table({1.0}));
    return ++made < 20;
  });
  auto focus = sink_of(uri("focus"));
  auto source = source_of(uri("out"));
  ASSERT_TRUE(focus->send(table<std::int32_t>({2})));
  start(module,
        {"--in", "focus=" + uri("focus"), "--modes=1", "--idle-rate=0.0001", "--out", uri("out")});
  Message message;
  ASSERT_TRUE(*receive(*source, message));  // the next would be hours away
  EXPECT_EQ(message.header.mode, 2);
  ASSERT_TRUE(focus->send(table<std::int32_t>({1})));
  EXPECT_EQ(join(), 0);
  EXPECT_EQ(made, 20);
  while (*source->take(message) == Got::Message) EXPECT_EQ(message.header.mode, 1);
}

TEST_F(RunningModule, ARateMayBeAsLowAsOneLikes) {
  Module module{"busy", "Works."};
  auto in = module.input("in", table<double>(), "");
  auto never = module.parameter("never", 0.0, "Hz", "");
  auto hardly = module.parameter("hardly", 1e-10, "Hz", "");
  int handled = 0, ticks = 0;
  module.on(in, [&](const auto&) { ++handled; });
  module.every(never, [&] { ++ticks; });
  module.every(hardly, [&] { ++ticks; });
  module.every(std::chrono::nanoseconds::max(), [&] { ++ticks; });
  auto sink = sink_of(uri("in")), focus = sink_of(uri("focus"));
  ASSERT_TRUE(focus->send(table<std::int32_t>({2})));
  for (int i = 0; i < 20; ++i) ASSERT_TRUE(sink->send(table({1.0})));
  ASSERT_TRUE(sink->close());
  start(module,
        {"--in=" + uri("in"), "--in", "focus=" + uri("focus"), "--modes=1", "--idle-rate=1e-10"});
  EXPECT_EQ(join(), 0);
  EXPECT_EQ(handled, 1);
  EXPECT_EQ(ticks, 0);
}

TEST_F(RunningModule, ATimerHearsOfItsRateAtOnce) {
  Module module{"clock", "Ticks."};
  auto rate = module.parameter("rate", 0.0, "Hz", "");
  auto sink = sink_of(uri("control"));
  module.every(rate, [&] { throw ModuleError("tick"); });
  start(module, {"--control=" + uri("control")});
  ASSERT_TRUE(tell(*sink, "set rate=1000"));
  EXPECT_EQ(join(), 1);
}

TEST_F(RunningModule, ATasksMessagesAreOfItsModeAndGoToAnAddress) {
  Module module{"task", "Commands."};
  auto in = module.input("in", table<double>(), "");
  auto out = module.output("command", table<double>(), "");
  module.on(in, [&](const auto&) { out.send(table({1.0})); });
  auto sink = sink_of(uri("in"));
  auto source = source_of(uri("out"));
  ASSERT_TRUE(sink->send(in_mode(table({1.0}), 9)));
  ASSERT_TRUE(sink->close());
  start(module, {"--in=" + uri("in"), "--out=" + uri("out"), "--mode=4", "--to=command=-5"});
  EXPECT_EQ(join(), 0);
  Message message;
  ASSERT_TRUE(*receive(*source, message));
  EXPECT_EQ(message.header.mode, 4);
  EXPECT_EQ(message.header.dst, -5);
}

TEST_F(RunningModule, ForwardsByAddressButNeverBack) {
  Module module{"router", "Passes on."};
  auto in = module.input("in", anything(), "");
  auto out = module.output("out", anything(), "");
  module.route_outputs();
  std::vector<std::size_t> taken;
  module.on_raw(in, [&](const Message& message) { taken.push_back(out.forward(message)); });
  auto from_a = sink_of(uri("from-a"));
  auto to_a = source_of(uri("to-a")), to_b = source_of(uri("to-b"));
  Message image =
      Draft::make({MatrixType::IntensityImage, 1, Scalar::U8, Encoding::Binary}, 8, 8).finish();
  image = *compress(image, Encoding::Zstd);
  image.header.src = 77;
  image.header.seq = 5;
  ASSERT_TRUE(from_a->send(to(image, 21)));
  ASSERT_TRUE(from_a->send(to(table({2.0}), -1)));
  ASSERT_TRUE(from_a->send(to(table({3.0}), 11)));
  ASSERT_TRUE(from_a->send(table({4.0})));
  ASSERT_TRUE(from_a->close());
  start(module, {"--in", "in=" + uri("from-a"), "--out", "out=" + uri("to-a"), "--out",
                 "out=" + uri("to-b"), "--route", "in=" + uri("from-a") + " peer=a", "--route",
                 "out=" + uri("to-a") + " to=11,-1 peer=a", "--route",
                 "out=" + uri("to-b") + " to=21,-1 peer=b"});
  EXPECT_EQ(join(), 0);
  EXPECT_EQ(taken, (std::vector<std::size_t>{1, 1, 0, 0}));
  Message message;
  ASSERT_TRUE(*receive(*to_b, message));
  EXPECT_EQ(message.header.info.encoding, Encoding::Zstd);  // as it came
  EXPECT_EQ(message.header.src, 77);
  EXPECT_EQ(message.header.seq, 5);
  ASSERT_TRUE(*receive(*to_b, message));
  EXPECT_EQ(message.header.dst, -1);
  EXPECT_FALSE(*receive(*to_b, message));
  EXPECT_FALSE(*receive(*to_a, message));
}

TEST_F(RunningModule, TimersGoOnBetweenMessages) {
  Module module{"clock", "Ticks."};
  auto in = module.input("in", table<double>(), "");
  module.on(in, [](const auto&) {});
  auto rate = module.parameter("rate", 1000.0, "Hz", "");
  int ticks = 0, counted = 0;
  auto sink = sink_of(uri("in"));
  module.every(rate, [&] {
    if (++ticks == 10) {
      ASSERT_TRUE(sink->close());
    }
  });
  module.every(std::chrono::hours(1), [&] { ++counted; });
  start(module, {"--in=" + uri("in")});
  EXPECT_EQ(join(), 0);
  EXPECT_GE(ticks, 10);
  EXPECT_EQ(counted, 0);
}

}  // namespace
}  // namespace hc
