// SPDX-License-Identifier: Apache-2.0
// What changes while a module runs: commands, modes, routes, timers.
#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <atomic>

#include <hc/compress/compress.h>
#include <hc/module/focus.h>
#include <hc/module/running_module_test.h>
#include <hc/mtp/matrix_view.h>

namespace hc {
namespace {

TEST_F(RunningModule, ObeysCommands) {
  Module module{"gauge", "Multiplies."};
  auto in = module.input("in", table(), "", {.actor = true});
  auto out = module.output("out", table(), "");
  auto factor = module.parameter("factor", 2.0, "", "", {.min = 0, .max = 10});
  auto title = module.parameter("title", "a", "", "", {.fixed = true});
  module.on(in, [&](const Doubles& m) { out.send({m.matrix().at(0, 0) * *factor}); });
  auto first = sink_of(uri("first"));
  start_managed(module, {"--in=" + uri("first"), "--out=" + uri("out")});
  next(*reports_, Report::Parameters);
  ::testing::internal::CaptureStderr();
  command("set factor=5");
  EXPECT_EQ(rows_of(next(*reports_, Report::Parameters))[0], "factor=5");
  auto from = source_of(uri("out"));
  ASSERT_TRUE(first->send(table().message({2.0})));
  EXPECT_EQ(number_of(next(*from)), 10);

  auto second = sink_of(uri("second"));
  auto other = source_of(uri("other"));
  relink("link in in=" + uri("second"));
  EXPECT_EQ(relink("link out out=" + uri("other")).size(), 4U);
  ASSERT_TRUE(second->send(table().message({3.0})));
  for (auto* each : {from.get(), other.get()}) EXPECT_EQ(number_of(next(*each)), 15);
  relink("unlink in in=" + uri("first"));
  EXPECT_EQ(relink("unlink out out=" + uri("out")),
            (std::vector<std::string>{"in in " + uri("second"), "out out " + uri("other")}));
  ASSERT_TRUE(second->send(table().message({1.0})));
  Message message = next(*other);
  EXPECT_FALSE(*receive(*from, message));

  // What is wrong changes nothing, and is an error.
  const std::string commands =
      "a command is set NAME=VALUE, link or unlink in|out PORT=URI, finish PORT=URI, route "
      "PORT=URI WORDS, or wall_offset NANOSECONDS";
  const std::pair<std::string, std::string> wrong[] = {
      {"set factor=-1", "parameter factor: \"-1\" is not from 0 to 10"},
      {"set factor", commands},
      {"set colour=1", "no parameter \"colour\""},
      {"set title=b", "parameter title is fixed while the module runs"},
      {"link up", commands},
      {"unlink out out=inproc:nowhere", "there is no such link"},
      {"route out=x via=y", "a route is to=ADDRESS,… and peer=NAME, not \"via\""},
      {"jump", commands}};
  for (const auto& [line, why] : wrong) command(line);
  for (const auto& [line, why] : wrong)
    EXPECT_EQ(read_log(next(*reports_, Report::Log))->text, "command \"" + line + "\": " + why);
  command("set factor=7");
  EXPECT_EQ(rows_of(next(*reports_, Report::Parameters)),
            (std::vector<std::string>{"factor=7", "title=a"}));
  // One whose inputs have all been unlinked waits for others.
  relink("unlink in in=" + uri("second"));
  auto third = sink_of(uri("third"));
  ASSERT_TRUE(third->close());
  command("link in in=" + uri("third"));
  EXPECT_EQ(join(), 0);
  EXPECT_EQ(*title, "a");
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

TEST_F(RunningModule, WhoReportsToNobodyLogsOnStandardErrorWhatIsWrong) {
  Taker module{"gauge"};
  auto sink = sink_of(uri("in")), control = sink_of(uri("control"));
  ::testing::internal::CaptureStderr();
  ASSERT_TRUE(send_command(*control, "set colour=1"));
  ASSERT_TRUE(sink->close());
  EXPECT_EQ(run(module, {"--in=" + uri("in"), "--control=" + uri("control")}), 0);
  EXPECT_EQ(::testing::internal::GetCapturedStderr(),
            "gauge: warning: command \"set colour=1\": no parameter \"colour\"\n");
}

TEST_F(RunningModule, InAGraphAReaderThatTakesNothingIsGivenUp) {
  Module module{"source", "Makes numbers."};
  auto out = module.output("out", table(), "");
  std::atomic<bool> is_enough{false};
  module.generate([&] {
    out.send(1.0);
    if (is_enough) module.stop();
  });
  const auto reader = source_of(uri("out"));  // and never reads
  start_managed(module, {"--out=" + uri("out")});
  while (view<std::int64_t>(next(*reports_, Report::State))->at(0, 0, 3) != 1) {
  }
  while (read_counters(next(*reports_, Report::Counters)).at(0).traffic.dropped_timeout == 0) {
  }
  is_enough = true;
  EXPECT_EQ(join(), 0);
}

TEST_F(RunningModule, AnExclusiveInputTakesTheModeInFocus) {
  ManualClock clock;  // stands still
  Module module{"actor", "Acts.", {.clock = &clock}};
  auto in = module.input("command", table(), "");
  auto out = module.output("done", table(), "");
  module.on(in, [&](const Doubles& m) { out.send({m.matrix().at(0, 0)}); });
  auto commands = sink_of(uri("in")), focus = sink_of(uri("focus"));
  auto done = source_of(uri("out"));
  auto reports = source_of(uri("reports"));
  start(module, {"--in=" + uri("in"), "--in", "focus=" + uri("focus"), "--out=" + uri("out"),
                 "--exclusive=command", "--manage=" + uri("reports")});
  auto set_focus = [&](std::int32_t mode) {
    ASSERT_TRUE(focus->send(table<std::int32_t>().message({mode})));
    while (view<std::int64_t>(next(*reports, Report::State))->at(0, 0, 1) != mode) {
    }
  };
  set_focus(2);
  ASSERT_TRUE(commands->send(in_mode(table().message({1.0}), 1)));
  ASSERT_TRUE(commands->send(in_mode(table().message({2.0}), 2)));
  Message message = next(*done);
  EXPECT_EQ(number_of(message), 2);
  EXPECT_EQ(message.header.mode, 2);
  set_focus(1);
  ASSERT_TRUE(commands->send(in_mode(table().message({3.0}), 2)));
  ASSERT_TRUE(commands->send(in_mode(table().message({4.0}), 1)));
  EXPECT_EQ(number_of(next(*done)), 4);
  set_focus(0);  // nobody
  ASSERT_TRUE(commands->send(in_mode(table().message({5.0}), 0)));
  ASSERT_TRUE(commands->send(in_mode(table().message({6.0}), 1)));
  ASSERT_TRUE(commands->close());
  EXPECT_EQ(join(), 0);
  EXPECT_FALSE(*receive(*done, message));
  EXPECT_EQ(last_counters(*reports).at(0).at(7), 4);
}

TEST_F(RunningModule, AFocusThatIsNotRepeatedExpires) {
  ManualClock clock;
  Module module{"actor", "Takes commands.", {.clock = &clock}};
  auto command = module.input("command", table(), "");
  auto direct = module.input("direct", table(), "");
  auto out = module.output("done", table(), "");
  for (const auto& input : {command, direct})
    module.on(input, [&](const Doubles& m) { out.send({m.matrix().at(0, 0)}); });
  auto commands = sink_of(uri("in")), person = sink_of(uri("direct")),
       focus = sink_of(uri("focus"));
  auto done = source_of(uri("out")), reports = source_of(uri("reports"));
  start(module,
        {"--in=command=" + uri("in"), "--in=direct=" + uri("direct"), "--in=focus=" + uri("focus"),
         "--out=" + uri("out"), "--exclusive=command", "--manage=" + uri("reports")});
  auto await_focus = [&](std::int64_t mode) {
    while (read_state(next(*reports, Report::State))->focus != mode) {
    }
  };
  ASSERT_TRUE(focus->send(table<std::int32_t>().message({1})));
  await_focus(1);
  clock.advance(internal::kFocusExpiry);
  ASSERT_TRUE(commands->send(in_mode(table().message({1.0}), 1)));
  EXPECT_EQ(number_of(next(*done)), 1);
  clock.advance(std::chrono::milliseconds(1));
  ASSERT_TRUE(commands->send(in_mode(table().message({2.0}), 1)));
  await_focus(0);
  ASSERT_TRUE(person->send(in_mode(table().message({3.0}), 1)));
  EXPECT_EQ(number_of(next(*done)), 3);
  ASSERT_TRUE(focus->send(table<std::int32_t>().message({1})));
  await_focus(1);
  ASSERT_TRUE(commands->send(in_mode(table().message({4.0}), 1)));
  EXPECT_EQ(number_of(next(*done)), 4);
  ASSERT_TRUE(commands->close());
  ASSERT_TRUE(person->close());
  EXPECT_EQ(join(), 0);
}

TEST_F(RunningModule, KnowsWhetherItsModeHasTheFocus) {
  auto has_focus = [&](std::vector<std::string> words, std::int32_t mode) {
    Module module{"task", "Knows."};
    auto in = module.input("in", table(), "");
    bool has = false;
    module.on(in, [&](const auto&) { has = module.has_focus(); });
    const std::string name = uri("in") + std::to_string(mode) + std::to_string(words.size());
    auto sink = sink_of(name), focus = sink_of(name + "focus");
    EXPECT_TRUE(focus->send(table<std::int32_t>().message({mode})));
    EXPECT_TRUE(sink->send(table().message({1.0})));
    EXPECT_TRUE(sink->close());
    words.push_back("--in=" + name);
    if (mode >= 0) words.insert(words.end(), {"--in", "focus=" + name + "focus"});
    EXPECT_EQ(run(module, words), 0);
    return has;
  };
  constexpr std::int32_t kNoFocus = -1;
  EXPECT_TRUE(has_focus({"--mode=2"}, kNoFocus));
  EXPECT_FALSE(has_focus({"--mode=2"}, 0));
  EXPECT_FALSE(has_focus({"--mode=2"}, 1));
  EXPECT_TRUE(has_focus({"--mode=2"}, 2));
  EXPECT_TRUE(has_focus({}, 1));
}

TEST_F(RunningModule, ARateMayBeAsLowAsOneLikes) {
  Module module{"busy", "Works."};
  auto in = module.input("in", table(), "");
  auto never = module.parameter("never", 0.0, "Hz", "");
  auto hardly = module.parameter("hardly", 1e-10, "Hz", "");
  int ticks = 0;
  module.on(in, [](const auto&) {});
  module.every(never, [&] { ++ticks; });
  module.every(hardly, [&] { ++ticks; });
  module.every(std::chrono::nanoseconds::max(), [&] { ++ticks; });
  auto sink = sink_of(uri("in"));
  for (int i = 0; i < 20; ++i) ASSERT_TRUE(sink->send(table().message({1.0})));
  ASSERT_TRUE(sink->close());
  EXPECT_EQ(run(module, {"--in=" + uri("in")}), 0);
  EXPECT_EQ(ticks, 0);
}

TEST_F(RunningModule, ATimerFollowsItsRateAtOnce) {
  Module module{"clock", "Ticks."};
  auto rate = module.parameter("rate", 0.0, "Hz", "");
  auto sink = sink_of(uri("control"));
  module.every(rate, [&] { throw ModuleError("tick"); });
  start(module, {"--control=" + uri("control")});
  ASSERT_TRUE(send_command(*sink, "set rate=1000"));
  EXPECT_EQ(join(), 1);
}

TEST_F(RunningModule, ATasksMessagesAreOfItsModeAndGoToAnAddress) {
  Module module{"task", "Commands."};
  auto in = module.input("in", table(), "");
  auto out = module.output("command", table(), "");
  module.on(in, [&](const auto&) { out.send(1.0); });
  auto sink = sink_of(uri("in"));
  auto source = source_of(uri("out"));
  ASSERT_TRUE(sink->send(in_mode(table().message({1.0}), 9)));
  ASSERT_TRUE(sink->close());
  EXPECT_EQ(
      run(module, {"--in=" + uri("in"), "--out=" + uri("out"), "--mode=4", "--to=command=-5"}), 0);
  const Message message = next(*source);
  EXPECT_EQ(message.header.mode, 4);
  EXPECT_EQ(message.header.dst, -5);
}

TEST_F(RunningModule, ForwardsByAddressButNeverBack) {
  Module module{"router", "Passes on.", {.routes = true}};
  auto in = module.input("in", anything(), "");
  auto out = module.output("out", anything(), "");
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
  ASSERT_TRUE(from_a->send(to(table().message({2.0}), -1)));
  ASSERT_TRUE(from_a->send(to(table().message({3.0}), 11)));
  ASSERT_TRUE(from_a->send(table().message({4.0})));
  ASSERT_TRUE(from_a->close());
  EXPECT_EQ(run(module, {"--in", "in=" + uri("from-a"), "--out", "out=" + uri("to-a"), "--out",
                         "out=" + uri("to-b"), "--route", "in=" + uri("from-a") + " peer=a",
                         "--route", "out=" + uri("to-a") + " to=11,-1 peer=a", "--route",
                         "out=" + uri("to-b") + " to=21,-1 peer=b"}),
            0);
  EXPECT_EQ(taken, (std::vector<std::size_t>{1, 1, 0, 0}));
  Message message = next(*to_b);
  EXPECT_EQ(message.header.info.encoding, Encoding::Zstd);  // as it came
  EXPECT_EQ(message.header.src, 77);
  EXPECT_EQ(message.header.seq, 5);
  EXPECT_EQ(next(*to_b).header.dst, -1);
  EXPECT_FALSE(*receive(*to_b, message));
  EXPECT_FALSE(*receive(*to_a, message));
}

TEST_F(RunningModule, TimersGoOnBetweenMessages) {
  Taker module{"clock"};
  auto rate = module.parameter("rate", 1000.0, "Hz", "");
  int ticks = 0, counted = 0;
  auto sink = sink_of(uri("in"));
  module.every(rate, [&] {
    if (++ticks == 10) {
      ASSERT_TRUE(sink->close());
    }
  });
  module.every(std::chrono::hours(1), [&] { ++counted; });
  EXPECT_EQ(run(module, {"--in=" + uri("in")}), 0);
  EXPECT_GE(ticks, 10);
  EXPECT_EQ(counted, 0);
}

TEST_F(RunningModule, IsWokenByADescriptorOfItsOwn) {
  Module module{"device", "Reads."};
  auto in = module.input("in", table(), "");
  auto sink = sink_of(uri("in"));
  std::array<int, 2> pipe = {};
  ASSERT_EQ(::pipe2(pipe.data(), O_NONBLOCK | O_CLOEXEC), 0);
  std::string read;
  std::atomic<bool> is_first_read = false;
  module.on(in, [&](const auto&) { ASSERT_EQ(::write(pipe[1], "a", 1), 1); });
  module.on_readable([] { return -1; }, [] {});  // none now
  module.on_readable([&] { return read == "ab" ? -1 : pipe[0]; },
                     [&] {
                       char byte = 0;
                       if (::read(pipe[0], &byte, 1) < 1) return;
                       read += byte;
                       is_first_read = true;
                       if (read == "ab") {
                         ASSERT_TRUE(sink->close());
                       }
                     });
  ASSERT_TRUE(sink->send(table().message({1.0})));
  start(module, {"--in=" + uri("in")});
  while (!is_first_read) std::this_thread::yield();
  ASSERT_EQ(::write(pipe[1], "b", 1), 1);  // nothing but this wakes it
  EXPECT_EQ(join(), 0);
  EXPECT_EQ(read, "ab");
  for (int end : pipe) ::close(end);
}

}  // namespace
}  // namespace hc
