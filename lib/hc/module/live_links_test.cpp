// SPDX-License-Identifier: Apache-2.0
// The links of a module that runs: what it reports of them, and how they come and go.
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <thread>

#include <hc/base/check.h>
#include <hc/contract/trace.h>
#include <hc/module/running_module_test.h>
#include <hc/mtp/matrix_view.h>

namespace hc {
namespace {

TEST_F(RunningModule, SaysWhatItIsLinkedToAndHowItIsSet) {
  Module module{"gauge", "Multiplies."};
  auto in = module.input("in", table(), "");
  auto out = module.output("out", table(), "");
  module.parameter("factor", 2.0, "", "");
  module.parameter("title", "a b", "", "", {.fixed = true});
  module.on(in, [](const auto&) {});
  auto sink = sink_of(uri("in"));
  start_managed(module, {"--in=" + uri("in"), "--out=" + uri("out"), "--mode=3", "--factor=4"});
  const Message parameters = next(*reports_);  // first: a module that is seen to run has them
  EXPECT_EQ(parameters.header.src, static_cast<int>(Report::Parameters));
  EXPECT_EQ(rows_of(parameters), (std::vector<std::string>{"factor=4", "title=a b"}));
  auto state = next(*reports_, Report::State);
  EXPECT_EQ(next_links(),
            (std::vector<std::string>{"in in " + uri("in"), "out out " + uri("out")}));
  auto numbers = view<std::int64_t>(state)->row(0);
  EXPECT_EQ(std::vector(numbers.begin(), numbers.end()), (std::vector<std::int64_t>{3, 0, 1, 0}));
  ASSERT_TRUE(sink->close());
  EXPECT_EQ(join(), 0);
}

TEST_F(RunningModule, ReportsThatItWaitsForAReader) {
  const std::string name = "early." + std::to_string(::getpid());
  for (const auto& [listens, comes] :
       {std::pair("shm:" + name, "shm:" + name), {"unix-listen:@" + name, "unix:@" + name}}) {
    Module module{"early", "Sends at once."};
    auto out = module.output("out", table(), "");
    module.generate([&] {
      out.send(1.0);
      module.stop();
    });
    auto reports = source_of(uri("reports"));
    auto awaits_reader = [&] {
      return view<std::int64_t>(next(*reports, Report::State))->at(0, 0, 3);
    };
    start(module, {"--out=" + listens, "--manage=" + uri("reports")});
    EXPECT_EQ(awaits_reader(), 0);
    EXPECT_EQ(awaits_reader(), 1);
    auto reader = source_of(comes);
    EXPECT_EQ(awaits_reader(), 0);
    next(*reader);
    EXPECT_EQ(join(), 0);
  }
}

TEST_F(RunningModule, ObeysWhileItWaitsForAReader) {
  const std::string link = "shm:unread." + std::to_string(::getpid());
  Module module{"unread", "Sends at once."};
  auto out = module.output("out", table(), "");
  auto factor = module.parameter("factor", 2.0, "", "");
  module.generate([&] {
    out.send(*factor);
    out.send(*factor);
    module.stop();
  });
  start_managed(module, {"--out=" + link});
  while (view<std::int64_t>(next(*reports_, Report::State))->at(0, 0, 3) == 0) {
  }
  command("set factor=4");
  EXPECT_EQ(rows_of(next(*reports_, Report::Parameters)).front(), "factor=4");
  command("unlink out out=" + link);
  EXPECT_EQ(join(), 0);
}

TEST_F(RunningModule, ObeysWhileItWaitsForRoom) {
  const std::string name = "slow." + std::to_string(::getpid());
  const std::string link = "shm:" + name + "?readers=1", other = uri("other");
  Module module{"fast", "Sends much."};
  auto out = module.output("out", table(), "");
  constexpr int kCount = 5000;  // more than wait for a reader
  int sent = 0;
  module.generate([&] {
    out.send(static_cast<double>(sent));
    if (++sent >= kCount) module.stop();
  });
  start_managed(module, {"--out=" + link, "--out=" + other});
  auto slow = source_of("shm:" + name + "?wait=10");  // and is not read
  auto quick = source_of(other);
  for (int received = 0; received < kCount; ++received) {
    if (received == 2000) command("unlink out out=" + link);
    // Every message, also the one that was being sent when the other link went.
    EXPECT_EQ(number_of(next(*quick)), received);
  }
  EXPECT_EQ(join(), 0);
}

TEST_F(RunningModule, ALinkThatIsAddedBeginsWithTheNextMessage) {
  const std::string name = "late." + std::to_string(::getpid());
  Module module{"counter", "Counts to two."};
  auto out = module.output("out", table(), "");
  module.generate([&] {
    for (int i = 0; i < 3; ++i) out.send(i);
    module.stop();
  });
  auto trace = source_of(uri("trace")), reader = source_of(uri("added"));
  start_managed(module, {"--out=shm:" + name, "--out=trace=" + uri("trace")});
  while (view<std::int64_t>(next(*reports_, Report::State))->at(0, 0, 3) == 0) {
  }
  command("link out out=" + uri("added"));
  command("set nothing=0");  // obeyed after it
  next(*reports_, Report::Log);
  auto old = source_of("shm:" + name + "?wait=10");
  for (int i = 0; i < 3; ++i) EXPECT_EQ(number_of(next(*old)), i);
  for (int i = 1; i < 3; ++i) EXPECT_EQ(number_of(next(*reader)), i);
  EXPECT_EQ(join(), 0);
  std::vector<std::int64_t> firsts;
  for (const auto& event : read_trace(next(*trace)))
    if (event.what == TraceEvent::What::Linked) firsts.push_back(event.seq);
  EXPECT_EQ(firsts, std::vector<std::int64_t>{1});
}

TEST_F(RunningModule, ReportsAgesAndGaps) {
  Taker module{"counted"};
  auto sink = sink_of(uri("in"));
  auto reports = source_of(uri("reports"));
  constexpr std::chrono::nanoseconds kHour = std::chrono::hours(1);
  for (int i = 0; i < 3; ++i) {
    Message message = table().message({1.0});
    message.header.time = SystemClock().wall() - kHour;
    ASSERT_TRUE(sink->send(message));
  }
  ASSERT_TRUE(sink->close());
  EXPECT_EQ(run(module, {"--in=" + uri("in"), "--manage=" + uri("reports")}), 0);
  const auto row = last_counters(*reports).at(0);
  ASSERT_EQ(row.size(), kCounterColumns.size());
  EXPECT_EQ(row[0], 3);
  EXPECT_EQ(row[7], 0);                  // omitted
  for (std::size_t i : {8U, 9U, 10U}) {  // ages
    EXPECT_GE(row[i], kHour.count());
    EXPECT_LT(row[i], (kHour + kHour / 7).count());
  }
  for (std::size_t i : {11U, 12U, 13U}) EXPECT_GE(row[i], 0);  // gaps
}

TEST_F(RunningModule, HasOnlyTheLinksOfItsCommands) {
  Relay module{"relay"};
  start_managed(module);
  // Neither standard input, which may have ended, nor standard output.
  EXPECT_TRUE(next_links().empty());
  auto first = sink_of(uri("first"));
  auto from = source_of(uri("out"));
  command("link out out=" + uri("out"));
  command("link in in=" + uri("first"));
  ASSERT_TRUE(first->send(table().message({2.0})));
  EXPECT_EQ(number_of(next(*from)), 2);
  ASSERT_TRUE(first->close());
  EXPECT_EQ(join(), 0);
}

TEST_F(RunningModule, ReportsWithoutLinksToo) {
  Taker module{"idle"};
  start_managed(module);
  for (int i = 0; i < 2; ++i) EXPECT_EQ(next(*reports_, Report::Counters).header.height, 0);
  end();
}

TEST_F(RunningModule, ALinkThatIsMadeAnewIsOneLinkAndCountsOn) {
  Relay module{"reader"};
  auto handled = source_of(uri("out"));
  auto other = sink_of(uri("other"));
  start_managed(module, {"--in=" + uri("other"), "--out=" + uri("out")});
  for (double i : {1, 2, 3}) {
    auto sink = open_sink(*parse_uri(uri("in")));
    while (!sink) sink = open_sink(*parse_uri(uri("in")));  // until the end before has closed
    command("link in in=" + uri("in"));
    ASSERT_TRUE((*sink)->send(table().message({i})));
    next(*handled);
    ASSERT_TRUE((*sink)->close());
  }
  auto rows = next_counters(*reports_);
  while (rows.back()[0] < 3) rows = next_counters(*reports_);
  ASSERT_EQ(rows.size(), 3U) << "the other, this one, and that out";
  EXPECT_EQ(rows[1][0], 3);
  command("unlink in in=" + uri("in"));
  std::vector<std::string> links;
  while (links.size() != 2) links = next_links();
  EXPECT_EQ(links, (std::vector{"in in " + uri("other"), "out out " + uri("out")}));
  ASSERT_TRUE(other->close());
  EXPECT_EQ(join(), 0);
}

TEST_F(RunningModule, ALinkThatIsTakenAwayHasItsLastNumbersReported) {
  Relay module{"relay"};
  auto sink = sink_of(uri("in"));
  auto from = source_of(uri("out"));
  start_managed(module, {"--in=" + uri("in"), "--out=" + uri("out")});
  EXPECT_EQ(next_counters(*reports_).size(), 2U);
  ASSERT_TRUE(sink->send(table().message({1.0})));
  next(*from);
  for (const auto& end : {"in in=" + uri("in"), "out out=" + uri("out")}) {
    command("unlink " + end);
    EXPECT_EQ(next_counters(*reports_).back()[0], 1);
    next(*reports_, Report::Links);
  }
  end();
}

TEST_F(RunningModule, WhatWaitsAtALinkThatIsTakenAwayIsAmongTheLost) {
  Relay module{"relay"};
  const std::string name = "@waits-" + std::to_string(::getpid()), place = "unix-listen:" + name;
  auto sink = sink_of(uri("in"));
  ::testing::internal::CaptureStderr();
  start_managed(module, {"--in=" + uri("in"), "--out=" + place + "?keep=100&rate=1"});
  auto from = source_of("unix:" + name + "?wait=60");
  for (int i = 0; i < 100; ++i) ASSERT_TRUE(sink->send(table().message({static_cast<double>(i)})));
  while (next_counters(*reports_).back()[0] < 100) {
  }
  command("unlink out out=" + place + "?keep=100&rate=1");
  auto row = next_counters(*reports_).back();
  while (row[6] == 0) row = next_counters(*reports_).back();
  EXPECT_EQ(row[0], 100);
  EXPECT_GT(row[6], 0);
  ASSERT_TRUE(sink->close());
  end();
  EXPECT_EQ(::testing::internal::GetCapturedStderr(),
            "relay: out: " + std::to_string(row[6]) + " waiting, lost with the link\n");
}

TEST_F(RunningModule, AnOutputThatNeverWaitsIsHeldUpByNoReader) {
  Module module{"relay", "Sends on."};
  auto in = module.input("in", table(), "");
  auto hung = module.output("hung", table(), "", {.keep = 1});
  auto out = module.output("out", table(), "");
  module.on(in, [&](const Doubles& m) {
    hung.send({m.matrix().at(0, 0)});
    out.send({m.matrix().at(0, 0)});
  });
  const std::string name = "hung-" + std::to_string(::getpid()), graph = "?readers=1&stay=1";
  auto sink = sink_of(uri("in"));
  auto from = source_of(uri("out"));
  // Of one reader nothing is ever seen, the others take nothing.
  start(module, {"--in=" + uri("in"), "--out=hung=shm:" + name + "-none" + graph,
                 "--out=hung=shm:" + name + graph + "&keep=all",
                 "--out=hung=unix-listen:@" + name + graph, "--out=out=" + uri("out")});
  auto shared = source_of("shm:" + name + "?wait=60");
  auto socket = source_of("unix:" + ("@" + name) + "?wait=60");
  constexpr int kMany = 20'000;  // of which no link has room for
  std::thread sender([&] {
    for (int i = 0; i < kMany; ++i)
      EXPECT_TRUE(sink->send(table().message({static_cast<double>(i)})));
  });
  for (int i = 0; i < kMany; ++i) next(*from);
  sender.join();
  shared.reset(), socket.reset();  // its end waits for what has begun to go
  EXPECT_TRUE(sink->close());
  EXPECT_EQ(join(), 0);
}

TEST_F(RunningModule, InputsThatAreTakenTogetherCanBeLinkedAnew) {
  Module module{"pair", "Adds."};
  auto left = module.input("left", table(), "");
  auto right = module.input("right", table(), "");
  auto out = module.output("out", table(), "");
  module.on(together(left, right), [&](const Doubles& l, const Doubles& r) {
    out.send({l.matrix().at(0, 0) + r.matrix().at(0, 0)});
  });
  auto sums = source_of(uri("out"));
  start_managed(module, {"--out=" + uri("out")});
  next(*reports_, Report::Links);
  std::string place = uri("left");
  auto l = sink_of(place), r = sink_of(uri("right"));
  relink("link in right=" + uri("right"));
  relink("link in left=" + place);
  for (double i : {1, 2}) {
    ASSERT_TRUE(l->send(table().message({i})));
    ASSERT_TRUE(r->send(table().message({i})));
    EXPECT_EQ(number_of(next(*sums)), 2 * i);
    relink("unlink in left=" + place);
    place += "_anew";
    l = sink_of(place);
    relink("link in left=" + place);
  }
  ASSERT_TRUE(l->close());
  EXPECT_EQ(join(), 0);
}

TEST_F(RunningModule, AFocusLinkIsTakenAwayAlone) {
  Taker module{"busy"};
  auto one = sink_of(uri("one")), other = sink_of(uri("other"));
  start_managed(module, {"--in", "focus=" + uri("one"), "--in", "focus=" + uri("other")});
  next(*reports_, Report::State);
  command("unlink in focus=" + uri("one"));
  relink("unlink in focus=" + uri("one"));
  EXPECT_EQ(read_log(next(*reports_, Report::Log))->text,
            "command \"unlink in focus=" + uri("one") + "\": there is no such link");
  ASSERT_TRUE(other->send(table<std::int32_t>().message({7})));
  EXPECT_EQ(view<std::int64_t>(next(*reports_, Report::State))->at(0, 0, 1), 7);
  end();
}

TEST_F(RunningModule, AWriterThatHasEndedForGoodIsNoNews) {
  const std::string name = "shm:writer-" + std::to_string(::getpid());
  Taker module{"reader"};
  ::testing::internal::CaptureStderr();
  auto writer = sink_of(name);
  start_managed(module, {"--in=" + name + "?reconnect=60"});
  ASSERT_TRUE(writer->send(table().message({1.0})));
  ASSERT_TRUE(writer->close());
  writer.reset();
  command("finish in=" + name + "?reconnect=60");
  EXPECT_EQ(join(), 0);
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

/// The name of the link that DISABLED_SendsOnce writes to.
constexpr const char* kWritten = "HC_TEST_WRITTEN";

/// A program, which is to be killed.
TEST(Writer, DISABLED_SendsOnce) {
  const char* link = std::getenv(kWritten);
  ASSERT_NE(link, nullptr);
  const auto sink = sink_of(link);
  ASSERT_TRUE(sink->send(table().message({1.0})));
  while (true) ::pause();
}

pid_t start_writer(const std::string& link) {
  ::setenv(kWritten, link.c_str(), 1);
  const char* words[] = {"module_test", "--gtest_also_run_disabled_tests",
                         "--gtest_filter=Writer.DISABLED_SendsOnce", nullptr};
  pid_t started = 0;
  HC_CHECK(::posix_spawn(&started, "/proc/self/exe", nullptr, nullptr,
                         const_cast<char* const*>(words), environ) == 0,
           errno);
  return started;
}

TEST_F(RunningModule, WhoNeverWaitsReadsTheWriterThatFollowsOneThatWasKilled) {
  const std::string name = "shm:killed-" + std::to_string(::getpid());
  for (const bool generates : {false, true}) {
    SCOPED_TRACE(generates);
    Module module{"busy", "Has always something to do."};
    std::atomic<int> come = 0;
    auto feed = sink_of(uri("feed"));
    module.on(module.input("feed", table(), ""), [&](const auto&) {
      ASSERT_TRUE(come < 2 && !generates ? feed->send(table().message({1.0})) : feed->close());
    });
    module.on(module.input("in", table(), ""), [&](const auto&) { ++come; });
    if (generates)
      module.generate([&] {
        if (come >= 2) module.stop();
      });
    module.on_start([&] { ASSERT_TRUE(feed->send(table().message({1.0}))); });
    start_managed(module, {"--in=feed=" + uri("feed"), "--in=in=" + name + "?reconnect=60"});
    const pid_t killed = start_writer(name);
    while (come < 1) std::this_thread::yield();
    ASSERT_EQ(::kill(killed, SIGKILL), 0);
    ASSERT_EQ(::waitpid(killed, nullptr, 0), killed);
    auto writer = sink_of(name);
    ASSERT_TRUE(writer->send(table().message({1.0})));
    while (come < 2) std::this_thread::yield();
    if (!generates) {
      ASSERT_TRUE(send_command(*control_, "finish in=" + name + "?reconnect=60"));
    }
    ASSERT_TRUE(control_->close());
    writer.reset();
    EXPECT_EQ(join(), 0);
    control_.reset();
    reports_.reset();
  }
}

TEST_F(RunningModule, ALinkOfAGraphIsNamedByItsPort) {
  const std::string nowhere = "unix:@nowhere-" + std::to_string(::getpid());
  Taker module{"reader"};
  start_managed(module);
  command("link in in=" + nowhere);
  const auto refusal = read_log(next(*reports_, Report::Log))->text;
  EXPECT_TRUE(refusal.starts_with("command \"link in in=" + nowhere + "\": Closed: in: "))
      << refusal;
  end();
}

}  // namespace
}  // namespace hc
