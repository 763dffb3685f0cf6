// SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <poll.h>

#include <mutex>
#include <optional>
#include <thread>

#include <hc/graph/run/running_test.h>
#include <hc/wire/rows.h>

namespace hc {
namespace {

using Lines = std::vector<std::string>;

std::string peer_of(const std::string& listening) {
  return "unix" + listening.substr(listening.find(':'));
}

/// A graph that is planned anew when it is asked to be, by the name that a test gave it.
class LiveChange : public Run {
 protected:
  LiveChange() {
    options_.name = "live";
    options_.replan = [this](Reading reading, const Lines& commands, const Plan&, int stop) {
      if (plans_) plans_(commands, stop);
      std::lock_guard lock(mutex_);
      commands_ = commands;
      reading_ = reading;
      Replanned planned;
      if (next_)
        planned.plan = *next_;
      else
        planned.problems = {"one problem", "another"};
      return planned;
    };
  }

  PlannedModule& add(const std::string& name, const std::string& script = "exec sleep 1000") {
    auto& module = Run::add(name, script);
    module.restart = Restart::Failure;
    module.control_uri = "unix-listen:@" + token_ + "." + name + ".control";
    module.options = {"-c", script + "; # "};
    return module;
  }

  /// Asks the graph that runs; gives its answer.
  static Lines ask(const Lines& commands, const std::string& who = "answer") {
    const std::string place = "@live-" + who + "-" + std::to_string(::getpid());
    auto answers = open_source({"unix-listen", place, {}});
    HC_CHECK(answers, answers.error().detail);
    Lines rows = {"reply unix:" + place};
    rows.insert(rows.end(), commands.begin(), commands.end());
    auto graph = open_sink(
        {"unix", "@hypercolumn.live." + std::to_string(::getpid()) + ".ask", {{"wait", "60"}}});
    HC_CHECK(graph, graph.error().detail);
    HC_CHECK((*graph)->send(make_rows(rows)));
    Message answer;
    HC_CHECK(receive(**answers, answer));
    return rows_of(answer);
  }

  /// Does something beside the graph, and ends it then.
  void beside(std::function<void()> what) {
    thread_ = std::thread([this, what = std::move(what)] {
      what();
      stop();
    });
  }

  Result<RunReport> run() {
    auto report = Run::run();
    if (thread_.joinable()) thread_.join();
    return report;
  }

  void plan_next(Plan plan) {
    std::lock_guard lock(mutex_);
    next_ = std::move(plan);
  }
  Lines commands() {
    std::lock_guard lock(mutex_);
    return commands_;
  }
  Reading reading() {
    std::lock_guard lock(mutex_);
    return reading_;
  }

  std::function<void(const Lines& commands, int stop)> plans_;  // hears that it is planned
  std::thread thread_;                                          // reads what the graph is made of

 private:
  std::mutex mutex_;
  std::optional<Plan> next_;
  Lines commands_;
  Reading reading_ = Reading::Anew;
};

TEST_F(LiveChange, WrongCommandsAreAnsweredAndChangeNothing) {
  add("camera");
  beside([&] {
    EXPECT_EQ(ask({"remov camera"}), Lines{"no command \"remov\", did you mean \"remove\"?"});
    EXPECT_EQ(ask({"stop it", "restart camra"}),
              (Lines{"the command is: stop", "no module \"camra\""}));
    EXPECT_EQ(ask({}), Lines{"there is no command"});
    EXPECT_EQ(ask({"remove camera"}), (Lines{"one problem", "another"}));
    plan_next(plan_);
    EXPECT_EQ(ask({"set camera.rate=3"}), Lines{"ok"});
    EXPECT_EQ(commands(), Lines{"set camera.rate=3"});
    EXPECT_EQ(reading(), Reading::AsBefore);
  });
  auto report = run();
  ASSERT_TRUE(report) << report.error().detail;
  EXPECT_EQ(count("camera: started"), 1);
}

/// Waits until somebody does not want to wait any more.
void await(int stop) {
  pollfd polled{stop, POLLIN, 0};
  HC_CHECK(::poll(&polled, 1, -1) == 1, "poll");
}

TEST_F(LiveChange, TheGraphGoesOnWhileAChangeIsPlanned) {
  add("a");
  internal::Descriptor again{::eventfd(0, EFD_CLOEXEC)};
  plans_ = [&](const Lines& commands, int) {
    if (commands == Lines{"set a.b=1"}) await(again.get());
  };
  heard_ = [&](std::string_view) {
    if (count("a: started") == 2) ::eventfd_write(again.get(), 1);
  };
  beside([&] {
    plan_next(plan_);
    std::thread slow([&] { EXPECT_EQ(ask({"set a.b=1"}, "slow"), Lines{"ok"}); });
    std::thread next([&] { EXPECT_EQ(ask({"set a.c=1", "restart a"}, "next"), Lines{"ok"}); });
    EXPECT_EQ(ask({"restart a"}), Lines{"ok"});
    slow.join();
    next.join();
    EXPECT_EQ(commands().size(), 2U);
  });
  ASSERT_TRUE(run());
}

TEST_F(LiveChange, AGraphEndsAtOnceWhileAChangeIsPlanned) {
  add("a");
  plans_ = [&](const Lines&, int stop) {
    Run::stop();
    await(stop);
  };
  thread_ = std::thread([&] { EXPECT_EQ(ask({"set a.b=1"}), Lines{"the graph is stopping"}); });
  auto report = run();
  ASSERT_TRUE(report);
  EXPECT_TRUE(report->stopped);
}

TEST_F(LiveChange, AnotherEditTakesThePlaceOfTheOneThatIsRead) {
  const std::string file = ::testing::TempDir() + token_ + ".toml";
  auto write = [&] { ::close(::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600)); };
  write();
  options_.files = {file};
  add("a");
  int plans = 0;
  plans_ = [&](const Lines&, int stop) {
    if (++plans > 1) return plan_next(plan_);
    write();
    await(stop);
  };
  heard_ = [&](std::string_view line) {
    if (line == "a: started") write();
  };
  stop_at_ = "graph: as it was";
  ASSERT_TRUE(run());
  ::unlink(file.c_str());
  EXPECT_EQ(plans, 2);
  EXPECT_FALSE(said("graph: goes on as it was"));
}

TEST_F(LiveChange, ModulesComeAndGo) {
  add("stays");
  add("comes");
  Plan other = plan_;
  plan_.modules.pop_back();
  add("goes");
  heard_ = [this](std::string_view) {
    if (count("goes: started") == 2) stop();
  };
  thread_ = std::thread([&] {
    plan_next(other);
    EXPECT_EQ(ask({"remove goes", "add comes program"}), Lines{"ok"});
    plan_next(plan_);
    EXPECT_EQ(ask({"add goes program"}), Lines{"ok"}) << "while it may be stopping still";
  });
  auto report = run();
  ASSERT_TRUE(report) << report.error().detail;
  EXPECT_EQ(count("stays: started"), 1);
  EXPECT_EQ(count("comes: started"), 1);
  EXPECT_EQ(count("goes: started"), 2);
  ASSERT_EQ(report->state.modules.size(), 2U);
  EXPECT_EQ(report->state.modules[1].name, "goes");
}

TEST_F(LiveChange, AnotherProgramIsStartedInThePlaceOfTheFirst) {
  add("a");
  stop_at_ = "a: other";
  thread_ = std::thread([&] {
    Plan other = plan_;
    other.modules[0].options = {"-c", "echo other >&2; exec sleep 1000"};
    plan_next(other);
    EXPECT_EQ(ask({"set a.b=1"}), Lines{"ok"});
  });
  ASSERT_TRUE(run());
  EXPECT_EQ(count("a: started"), 2);
}

TEST_F(LiveChange, StopIsACommand) {
  add("a");
  thread_ = std::thread([&] { EXPECT_EQ(ask({"stop"}), Lines{"ok"}); });
  auto report = run();
  ASSERT_TRUE(report) << report.error().detail;
  EXPECT_TRUE(report->stopped);
}

/// Listens to what a module is told, in its place.
class Listener {
 public:
  explicit Listener(const PlannedModule& module)
      : source_(std::move(*open_source(*parse_uri(peer_of(module.control_uri) + "?wait=60")))) {}
  /// The next command; empty when the process has ended.
  std::string next() {
    Message message;
    auto received = receive(*source_, message);
    HC_CHECK(received, received.error().detail);
    return *received ? rows_of(message).at(0) : "";
  }

 private:
  std::unique_ptr<Source> source_;
};

TEST_F(LiveChange, AModuleThatListensIsTold) {
  auto& camera = add("camera");
  camera.parameters = {{"rate", "30"}};
  camera.ends = {{false, "left", "shm:t.left?readers=1", ""}};
  add("view").ends = {{true, "image", "shm:t.left?reconnect=86400", ""}};
  beside([&] {
    Listener first(plan_.modules[0]), second(plan_.modules[1]);
    Plan other = plan_;
    other.modules[0].parameters["rate"] = "10";
    other.modules[0].ends = {{false, "left", "shm:t.own?readers=1&rate=5", "to=5"}};
    other.modules[1].ends = {{true, "image", "shm:t.own?reconnect=86400", ""}};
    plan_next(other);
    EXPECT_EQ(ask({"set camera.rate=10"}), Lines{"ok"});
    EXPECT_EQ(first.next(), "unlink out left=shm:t.left?readers=1");
    EXPECT_EQ(first.next(), "set rate=10");
    EXPECT_EQ(first.next(), "link out left=shm:t.own?readers=1&rate=5");
    EXPECT_EQ(first.next(), "route left=shm:t.own?readers=1&rate=5 to=5");
    EXPECT_EQ(second.next(), "unlink in image=shm:t.left?reconnect=86400");
    EXPECT_EQ(second.next(), "link in image=shm:t.own?reconnect=86400");
  });
  ASSERT_TRUE(run());
  EXPECT_EQ(count("camera: started"), 1);
  EXPECT_TRUE(said("camera: set rate=10"));
}

TEST_F(LiveChange, ACommandThatAModuleRefusesIsTold) {
  add("camera");
  stop_at_ = "camera: command \"set rate=-1\": too small";
  thread_ = std::thread([&] {
    auto reports = open_sink(*parse_uri(peer_of(plan_.modules[0].manage_uri) + "?wait=60"));
    HC_CHECK(reports, reports.error().detail);
    Message message = make_rows(Lines{"command \"set rate=-1\": too small"});
    message.header.src = 5;
    EXPECT_TRUE((*reports)->send(message));
  });
  options_.tells_lines = false;
  ASSERT_TRUE(run());
}

TEST_F(LiveChange, WhoComesToListenIsToldTheDifference) {
  auto& camera = add("camera");
  camera.parameters = {{"rate", "0"}};
  camera.ends = {{true, "in", "unix:@a?reconnect=1", ""}};
  beside([&] {
    Plan other = plan_;
    for (int i = 1; i <= 1100; ++i) {
      other.modules[0].parameters["rate"] = std::to_string(i);
      other.modules[0].ends[0].uri = "unix:@" + std::to_string(i) + "?reconnect=1";
      plan_next(other);
      EXPECT_EQ(ask({"set camera.rate=" + std::to_string(i)}), Lines{"ok"});
    }
    EXPECT_EQ(ask({"set camera.rate=1101"}), Lines{"ok"});  // which makes no difference
    Listener module(plan_.modules[0]);
    EXPECT_EQ(module.next(), "unlink in in=unix:@a?reconnect=1");
    EXPECT_EQ(module.next(), "set rate=1100");
    EXPECT_EQ(module.next(), "link in in=unix:@1100?reconnect=1");
    other.modules[0].parameters["rate"] = "0";
    plan_next(other);
    EXPECT_EQ(ask({"set camera.rate=0"}), Lines{"ok"});
    EXPECT_EQ(module.next(), "set rate=0");
  });
  ASSERT_TRUE(run());
  EXPECT_EQ(count("camera: started"), 1);
  EXPECT_EQ(count("graph: as it was"), 1);
}

TEST_F(LiveChange, AnotherProgramMayTakeCommandsWhereTheFirstDidNot) {
  add("a");
  Plan with = plan_;
  with.modules[0].parameters = {{"rate", "1"}};
  plan_.modules[0].control_uri.clear();
  const Plan without = plan_;
  heard_ = [this](std::string_view) {
    if (count("a: started") == 3) stop();
  };
  thread_ = std::thread([&] {
    plan_next(with);
    EXPECT_EQ(ask({"set a.b=1"}), Lines{"ok"});
    { Listener listener(with.modules[0]); }
    plan_next(without);
    EXPECT_EQ(ask({"set a.b=2"}), Lines{"ok"});
  });
  auto report = run();
  ASSERT_TRUE(report);
  EXPECT_EQ(count("a: started"), 3);
}

TEST_F(LiveChange, WhoHasEndedRestsUntilThereIsMoreToRead) {
  auto& reader = add("reader", "exit 0");
  reader.ends = {{true, "in", "unix:@one?wait=1", ""}, {true, "in", "unix:@two?wait=1", ""}};
  add("stays");
  heard_ = [this](std::string_view line) {
    if (line != "reader: ended" || thread_.joinable()) return;
    thread_ = std::thread([this] {
      Plan other = plan_;
      other.modules[0].ends.pop_back();
      plan_next(other);
      EXPECT_EQ(ask({"unlink x.out reader.in"}), Lines{"ok"});
      other.modules[0].ends.push_back({true, "in", "unix:@three?wait=1", ""});
      plan_next(other);
      EXPECT_EQ(ask({"link x.out reader.in"}), Lines{"ok"});
      stop();
    });
  };
  ASSERT_TRUE(run());
  EXPECT_EQ(count("reader: started"), 2);
}

TEST_F(LiveChange, AReaderIsToldThatItsWriterHasEnded) {
  const std::string out = "shm:t.out?readers=1&stay=1", in = "shm:t.out?reconnect=86400";
  add("writer", "exit 0").ends = {{false, "out", out, ""}};
  add("reader").ends = {{true, "in", in, ""}};
  plan_.links = {{"writer.out", "reader.in", out, in, "all", {}, true}};
  beside([&] {
    Listener reader(plan_.modules[1]);
    EXPECT_EQ(reader.next(), "finish in=" + in);
    EXPECT_EQ(ask({"restart reader"}), Lines{"ok"});
    EXPECT_EQ(reader.next(), "");
    Listener again(plan_.modules[1]);
    EXPECT_EQ(again.next(), "finish in=" + in) << "its next process has to know it too";
  });
  ASSERT_TRUE(run());
}

TEST_F(LiveChange, AnEditedFileIsReadAnew) {
  const std::string file = ::testing::TempDir() + token_ + ".toml";
  auto write = [&] { ::close(::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600)); };
  write();
  options_.files = {file};
  add("a");
  heard_ = [&](std::string_view line) {
    if (line == "a: started") write();
    if (line == "graph: goes on as it was") {
      EXPECT_EQ(reading(), Reading::Anew);
      plan_next(plan_);
      write();
    }
    if (line == "graph: as it was") {
      Plan other = plan_;
      other.modules.push_back(plan_.modules[0]);
      other.modules[1].name = "b";
      other.modules[1].manage_uri += "2";
      other.modules[1].control_uri.clear();
      plan_next(other);
      write();
    }
    if (line == "b: started") stop();
  };
  ASSERT_TRUE(run());
  ::unlink(file.c_str());
  EXPECT_TRUE(said("graph: one problem"));
  EXPECT_TRUE(said("graph: another"));
  EXPECT_EQ(count("a: started"), 1);
}

TEST_F(LiveChange, AFileThatIsTakenAwayIsToldOnce) {
  const std::string file = ::testing::TempDir() + token_ + ".toml";
  auto write = [&] { ::close(::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600)); };
  write();
  options_.files = {file};
  add("a");
  plan_next(plan_);
  const std::string is_gone = "graph: " + file + " is gone; it runs on as it was";
  heard_ = [&](std::string_view line) {
    if (line == "a: started") ::unlink(file.c_str());
    if (line != is_gone) return;
    write();
    ::unlink(file.c_str());
  };
  int states = 0;
  options_.state = [&](const GraphState&) {
    // By the second it has been noticed that the file was there, and is gone again.
    if (said(is_gone) && ++states == 3) write();
  };
  stop_at_ = "graph: as it was";
  ASSERT_TRUE(run());
  ::unlink(file.c_str());
  EXPECT_EQ(lines_,
            (Lines{"a: started", is_gone, "graph: as it was", "graph: stopping", "a: ended"}));
}

TEST_F(LiveChange, TheStateIsToldAsJson) {
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
                           "\"mode\":\"track\"", "\"modes\":{\"track\":1}", "\"focus\":null"})
    EXPECT_NE(text.find(part), std::string::npos) << part << " in " << text;
  EXPECT_EQ(line.substr(0, 8), "camera: ");
}

}  // namespace
}  // namespace hc
