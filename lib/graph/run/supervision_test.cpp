// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <map>
#include <set>
#include <thread>

#include <graph/run/running_test.h>
#include <hc/link/link.h>
#include <hc/mtp/rows.h>
#include <hc/testing/must.h>

namespace hc {
namespace {

using namespace std::chrono_literals;

/// Modules that end, or do nothing any more.
class Supervision : public Run {
 protected:
  Supervision() {
    options_.limits.restarts.first_delay = 1ms;
    options_.limits.restarts.longest_delay = 2ms;
  }

  PlannedModule& add(const std::string& name, const std::string& script,
                     Restart restart = Restart::Failure) {
    auto& module = Run::add(name, script);
    module.restart = restart;
    return module;
  }
  static const ModuleState& module(const RunReport& report, const std::string& name) {
    return *std::find_if(report.state.modules.begin(), report.state.modules.end(),
                         [&](const auto& each) { return each.name == name; });
  }
};

TEST_F(Supervision, OneThatIsKilledComesBackAndTheOthersGoOn) {
  add("a", "echo $$ >&2; exec sleep 1000");
  add("b", "exec sleep 1000");
  heard_ = [this](std::string_view line) {
    if (line.starts_with("a: ") && line[3] >= '0' && line[3] <= '9') {
      if (count("a: started") == 3) return stop();
      ASSERT_EQ(::kill(std::stoi(std::string(line.substr(3))), SIGKILL), 0);
    }
  };
  auto report = must(run());
  EXPECT_EQ(count("a: killed by signal 9; restarting"), 2);
  EXPECT_EQ(count("b: started"), 1);
  EXPECT_EQ(module(report, "a").restarts, 2);
  EXPECT_EQ(module(report, "b").restarts, 0);
}

TEST_F(Supervision, OneThatEndsBeforeItsCutOffWriterDoesIsRestarted) {
  add("first", "echo $$ >&2; exec sleep 1000");
  add("second", "exec sleep 1000");
  add("third", "trap 'exit 0' USR1; echo $$ >&2; while :; do sleep 1000 & wait; done");
  plan_.links = {{"first.out", "second.in", "", "", "all", {}, false},
                 {"second.out", "third.in", "", "", "all", {}, false}};
  std::map<std::string, pid_t> pids;
  heard_ = [&](std::string_view line) {
    const auto name = std::string(line.substr(0, line.find(':')));
    const auto number = std::atoi(std::string(line.substr(name.size() + 2)).c_str());
    if (number > 0 && pids.emplace(name, number).second && pids.size() == 2)
      ::kill(pids["first"], SIGKILL);
    if (line == "first: killed by signal 9; restarting") ::kill(pids["third"], SIGUSR1);
    if (line.starts_with("third: ended")) stop();
  };
  ASSERT_TRUE(run());
  EXPECT_EQ(count("third: ended; restarting"), 1);
}

TEST_F(Supervision, OneThatEndsAtOnceIsPutOffAndGivenUp) {
  add("a", "exit 3");
  auto report = must(run());
  EXPECT_EQ(count("a: started"), 13);
  EXPECT_EQ(count("a: failed with status 3; restarting"), 4);
  EXPECT_EQ(lines_.back(), "a: failed with status 3; failed permanently after 13 starts");
  EXPECT_EQ(module(report, "a").status, ModuleStatus::GivenUp);
  EXPECT_EQ(module(report, "a").exit, 3);
}

TEST_F(Supervision, BadArgumentsWouldBeBadAgain) {
  add("a", "exit 2");
  must(run());
  EXPECT_EQ(lines_,
            (std::vector<std::string>{
                "a: started", "a: failed with status 2 (bad arguments); failed permanently"}));
}

TEST_F(Supervision, OneThatSendsNoReportsIsSeenToBeStopped) {
  add("a", "echo $$ >&2; exec sleep 1000");
  pid_t process = 0;
  heard_ = [&](std::string_view line) {
    if (line.starts_with("a: ") && line[3] >= '0' && line[3] <= '9') {
      process = std::stoi(std::string(line.substr(3)));
      ::kill(process, SIGSTOP);
    }
    if (line == "a: unresponsive: stopped by a signal") ::kill(process, SIGCONT);
    if (line == "a: resumed") stop();
  };
  must(run());
  EXPECT_EQ(count("a: unresponsive: stopped by a signal"), 1);
}

TEST_F(Supervision, AlwaysIsAfterAGoodEndToo) {
  add("a", "exit 0", Restart::Always);
  heard_ = [this](std::string_view) {
    if (count("a: started") == 7) stop();
  };
  must(run());
  EXPECT_EQ(count("a: ended; restarting"), 4);
}

TEST_F(Supervision, AStoppingGraphStartsNothingAgain) {
  options_.limits.restarts.first_delay = options_.limits.restarts.longest_delay = 1h;
  add("a", "exit 3");
  add("b", "exec sleep 1000");
  heard_ = [this](std::string_view line) {
    if (line.find("restarting in") != std::string_view::npos) stop();
  };
  auto report = must(run());
  EXPECT_TRUE(report.stopped);
  EXPECT_EQ(module(report, "a").status, ModuleStatus::Ended);
}

TEST_F(Supervision, WhoDoesNotEndWhenAskedToIsKilled) {
  options_.limits.grace = 10ms;
  add("a", "trap '' TERM; echo ready >&2; while :; do sleep 1000; done");
  stop_at_ = "a: ready";
  must(run());
  EXPECT_TRUE(said("a: killed by signal 9"));
}

TEST_F(Supervision, AQuietOnePrintsItsLastLinesWhenItFails) {
  options_.with_module_lines = false;
  add("a", "seq 1 30 >&2; exit 2");
  ASSERT_TRUE(run());
  ASSERT_EQ(lines_.size(), 22U);
  EXPECT_EQ(lines_[1], "a: 11");
  EXPECT_EQ(lines_[20], "a: 30");
}

/// Reports, as a module does, on the thread that hears of the graph.
class Reporter {
 public:
  explicit Reporter(const std::string& manage_uri) {
    sink_ = std::move(*open_sink(*parse_uri(peer_of(manage_uri))));
  }
  void report(std::int32_t src, Message message) {
    message.header.src = src;
    ASSERT_TRUE(sink_->send(message));
  }
  void count(std::int64_t messages) { report(1, std::array{messages, 10 * messages}); }
  void publish_state(bool awaits_reader) {
    report(4, std::array<std::int64_t, 4>{0, 0, 1, awaits_reader ? 1 : 0});
  }
  template <std::size_t kSize>
  void report(std::int32_t src, const std::array<std::int64_t, kSize>& numbers) {
    Draft draft = Draft::make({MatrixType::Table, kSize, Scalar::I64, Encoding::Binary}, 1, 1);
    std::copy(numbers.begin(), numbers.end(), draft.view<std::int64_t>().numbers().begin());
    report(src, std::move(draft).finish());
  }

 private:
  std::unique_ptr<Sink> sink_;
};

TEST_F(Supervision, OneThatIsStoppedIsShownAsStalledAndGoesOn) {
  options_.limits.stall = 50ms;
  add("a", "kill -STOP $$; exec sleep 1000");
  std::unique_ptr<Reporter> reporter;
  heard_ = [&](std::string_view line) {
    if (line == "a: started") {
      reporter = std::make_unique<Reporter>(plan_.modules[0].manage_uri);
      reporter->count(1);
    }
    if (line == "a: unresponsive: stopped by a signal" || line == "a: unresponsive: busy")
      reporter->count(2);
    if (line == "a: resumed") stop();
  };
  must(run());
  EXPECT_TRUE(said("a: resumed"));
}

TEST_F(Supervision, OneThatWaitsForAReaderIsNotStalledUnlessItIsStopped) {
  options_.limits.stall = 50ms;
  add("a", "echo $$ >&2; exec sleep 1000");
  std::unique_ptr<Reporter> reporter;
  pid_t process = 0;
  heard_ = [&](std::string_view line) {
    if (line == "a: started") {
      reporter = std::make_unique<Reporter>(plan_.modules[0].manage_uri);
      reporter->publish_state(true);
    }
    if (line.starts_with("a: ") && line[3] >= '0' && line[3] <= '9')
      process = std::stoi(std::string(line.substr(3)));
    if (line == "a: unresponsive: busy") stop();
  };
  std::vector<std::string> seen;
  options_.state = [&](const GraphState& state) {
    const auto& detail = state.modules.at(0).detail;
    if (detail.empty() || process == 0 || (!seen.empty() && seen.back() == detail)) return;
    seen.push_back(detail);
    const bool is_stopped = state.modules.at(0).status == ModuleStatus::Stalled;
    if (is_stopped || seen.size() == 1) ::kill(process, is_stopped ? SIGCONT : SIGSTOP);
    if (seen.size() == 3) reporter->publish_state(false);
  };
  must(run());
  EXPECT_EQ(seen, (std::vector<std::string>{"blocked: waits for its reader", "stopped by a signal",
                                            "blocked: waits for its reader"}));
}

TEST_F(Supervision, OneThatHangsIsKilledAndRestarted) {
  add("hung", "exec sleep 1000").hang = 1s;
  add("stopped", "exec sleep 1000").hang = 1s;
  add("waits", "exec sleep 1000").hang = 1s;  // for a reader, which is not its fault
  add("patient", "exec sleep 1000");
  std::map<std::string, std::unique_ptr<Reporter>> reporters;
  std::set<std::string> again;
  heard_ = [&](std::string_view line) {
    const std::string name(line.substr(0, line.find(':')));
    if (line.ends_with(": started")) {
      const auto module = std::ranges::find(plan_.modules, name, &PlannedModule::name);
      if (reporters.contains(name)) again.insert(name);
      reporters[name] = std::make_unique<Reporter>(module->manage_uri);
      reporters[name]->publish_state(name == "waits");
    }
    if (again == std::set<std::string>{"hung", "stopped"}) stop();
  };
  options_.state = [&](const GraphState& state) {
    for (const auto& module : state.modules)
      if (module.name == "stopped" && module.process > 0 && !again.contains("stopped"))
        ::kill(module.process, SIGSTOP);
  };
  auto report = must(run());
  EXPECT_TRUE(said("hung: hung for 1 s; restarting"));
  EXPECT_TRUE(said("stopped: hung for 1 s; restarting"));
  EXPECT_EQ(module(report, "hung").restarts, 1);
  EXPECT_EQ(module(report, "waits").restarts, 0);
  EXPECT_EQ(module(report, "patient").restarts, 0);
}

TEST_F(Supervision, OneThatHangsBeforeItsFirstReportIsKilledAndRestarted) {
  options_.limits.first_report = 1s;
  for (const std::string name : {"hung", "stopped", "silent", "stopped_silent"}) {
    auto& module = add(name, "exec sleep 1000");
    module.hang = 1s;
    if (!name.ends_with("silent")) module.control_uri = "unix-listen:@" + token_ + "." + name;
  }
  options_.state = [&](const GraphState& state) {
    for (const auto& module : state.modules)
      if (module.name.starts_with("stopped") && module.process > 0 && module.restarts == 0)
        ::kill(module.process, SIGSTOP);
  };
  std::set<std::string> hung;
  heard_ = [&](std::string_view line) {
    if (line.ends_with(": hung for 1 s; restarting")) hung.emplace(line, 0, line.find(':'));
    if (hung.size() == 3) stop();
  };
  must(run());
  EXPECT_EQ(hung, (std::set<std::string>{"hung", "stopped", "stopped_silent"}));
}

TEST_F(Supervision, OneThatLoadsForLongerThanItsHangIsLeftAlone) {
  options_.limits.first_report = 1h;
  auto& slow = add("slow", "exec sleep 1000");
  slow.hang = 1s;
  slow.control_uri = "unix-listen:@" + token_ + ".slow";
  add("hung", "exec sleep 1000").hang = 3s;
  std::unique_ptr<Reporter> reporter;
  heard_ = [&](std::string_view line) {
    if (line == "hung: started") {
      if (reporter) return stop();
      reporter = std::make_unique<Reporter>(plan_.modules[1].manage_uri);
      reporter->publish_state(false);
    }
  };
  auto report = must(run());
  EXPECT_TRUE(said("hung: hung for 3 s; restarting"));
  EXPECT_EQ(module(report, "slow").restarts, 0);
}

TEST_F(Supervision, OneThatWaitsSaysForWhomSinceWhen) {
  const std::string uri = "unix-listen:@" + token_ + ".a.out";
  add("a", "exec sleep 1000").ends = {{false, "out", uri, ""}};
  add("b", "exec sleep 1000").ends = {{true, "in", peer_of(uri), ""}};
  plan_.links = {{"a.out", "b.in", uri, peer_of(uri), "all", {}, false}};
  std::unique_ptr<Reporter> reporter;
  heard_ = [&](std::string_view line) {
    if (line != "a: started") return;
    reporter = std::make_unique<Reporter>(plan_.modules[0].manage_uri);
    reporter->publish_state(true);
  };
  std::optional<double> waits;
  options_.state = [&](const GraphState& state) {
    const auto& a = state.modules.at(0);
    if (!a.waits) return;
    EXPECT_EQ(a.waits_for, "b.in");
    if (waits && *a.waits > *waits) stop();
    waits = a.waits;
  };
  must(run());
  EXPECT_TRUE(waits);
}

TEST_F(Supervision, CountsAreThoseOfAllProcesses) {
  auto& module = add("a", "read line </dev/null; exit 1", Restart::Failure);
  module.ends = {{false, "out", "unix-listen:@" + token_ + ".a.out", ""}};
  plan_.links = {{"a.out", "tcp:1", module.ends[0].uri, "", "all", {}, false}};
  heard_ = [&](std::string_view line) {
    if (line == "a: started") Reporter(plan_.modules[0].manage_uri).count(5);
  };
  auto report = must(run());
  EXPECT_EQ(report.state.links.at(0).traffic.messages, 65U);
}

TEST_F(Supervision, TheRateOfALinkIsOfWhatItsReaderTakes) {
  const std::string uri = "unix-listen:@" + token_ + ".out";
  add("writer", "exec sleep 1000").ends = {{false, "out", uri, ""}};
  add("reader", "exec sleep 1000").ends = {{true, "in", peer_of(uri), ""}};
  plan_.links = {{"writer.out", "reader.in", uri, peer_of(uri), "all", {}, false}};
  std::vector<std::pair<Reporter, std::int64_t>> reporters;  // and the bytes of a message
  heard_ = [&](std::string_view line) {
    if (line.ends_with(": started"))
      reporters.emplace_back(plan_.modules[reporters.size()].manage_uri,
                             line.starts_with("reader") ? 7 : 10);
  };
  LinkState link;
  std::int64_t count = 0;
  options_.state = [&](const GraphState& state) {
    link = state.links.at(0);
    if (link.per_second > 0) return stop();
    if (reporters.size() < 2) return;
    count += 9;
    for (auto& [reporter, bytes] : reporters)
      reporter.report(1, std::array<std::int64_t, 4>{count, count * bytes, 0, 1});
  };
  must(run());
  EXPECT_DOUBLE_EQ(link.bytes_per_second, 7 * link.per_second);
  EXPECT_EQ(link.traffic.bytes, 10 * link.traffic.messages);
}

TEST_F(Supervision, AReportThatIsTooLargeIsNotTaken) {
  add("a", "exec sleep 1000");
  options_.limits.stall = 1ms;  // shows that the next one has been taken
  std::thread reporting;
  heard_ = [&](std::string_view line) {
    if (line == "a: started")
      reporting = std::thread([uri = plan_.modules[0].manage_uri] {
        auto large = make_rows(std::array{"large=" + std::string(std::size_t{2} << 20, 'x')});
        large.header.src = 3;
        // Whether all of it can be sent before we are left is a matter of luck.
        static_cast<void>((*open_sink(*parse_uri(peer_of(uri))))->send(large));
        Reporter(uri).count(1);
      });
    if (line == "a: unresponsive: busy") stop();
  };
  auto report = run();
  reporting.join();
  ASSERT_TRUE(report) << report.error().detail;
  EXPECT_TRUE(module(*report, "a").parameters.empty());
}

TEST_F(Supervision, AModuleAllOfWhoseReadersHaveEndedEnds) {
  add("writer", "exec sleep 1000");
  add("between", "exec sleep 1000");
  add("reader", "exit 0");
  plan_.links = {{"writer.out", "between.in", "", "", "", {}, false},
                 {"between.out", "reader.in", "", "", "", {}, false}};
  auto report = must(run());
  EXPECT_FALSE(report.stopped);
  for (const auto& each : report.state.modules) EXPECT_EQ(each.status, ModuleStatus::Ended);
}

TEST_F(Supervision, AModuleThatEndsTheGraphTakesAllOthersWithIt) {
  add("score", "exit 0").ends_graph = true;
  add("writer", "exec sleep 1000");
  add("reader", "exec sleep 1000");
  plan_.links = {{"writer.out", "reader.in", "", "", "", {}, false},
                 {"reader.out", "writer.in", "", "", "", {}, false}};
  auto report = must(run());
  EXPECT_FALSE(report.stopped);
  for (const auto& each : report.state.modules) EXPECT_EQ(each.status, ModuleStatus::Ended);
}

TEST_F(Supervision, WhoFailsThoughNobodyNeedsItHasFailed) {
  add("writer", "trap 'exit 7' TERM; echo ready >&2; while :; do sleep 0.01; done", Restart::Never);
  add("reader", "trap 'exit 0' TERM; echo $$ >&2; while :; do sleep 0.01; done");
  plan_.links = {{"writer.out", "reader.in", "", "", "", {}, false}};
  std::string reader;
  heard_ = [&](std::string_view line) {
    if (line.starts_with("reader: ") && line[8] >= '0' && line[8] <= '9') reader = line.substr(8);
    if (!reader.empty() && said("writer: ready")) ::kill(std::stoi(reader), SIGTERM);
  };
  EXPECT_EQ(refused(run()).detail, "module writer: failed with status 7");
}

/// What the test writes in the place of the module "writer" comes to readers, or to those in their
/// place: all the output's `readers` are waited for.
class StandIns : public Supervision {
 protected:
  void write_for(const std::string& sender_uri) {
    add("writer", "exec sleep 1000");
    heard_ = [this, sender_uri](std::string_view line) {
      failures_ += line.find(": failed") != std::string_view::npos ? 1 : 0;
      if (failures_ < static_cast<int>(plan_.links.size()) || thread_.joinable()) return;
      thread_ = std::thread([this, sender_uri] {
        auto sink = must(open_sink(*parse_uri(sender_uri)));
        EXPECT_TRUE(sink->send(make_rows(std::array{std::string("for nobody")})));
        stop();
      });
    };
    auto report = run();
    thread_.join();
    ASSERT_TRUE(report) << report.error().detail;
  }
  void add_link(const std::string& reader, const std::string& uri, const std::string& in,
                bool lasts) {
    add(reader, "exit 2");
    plan_.links.push_back({"writer.out", reader + ".in", uri, in, "all", {}, lasts});
  }

  int failures_ = 0;
  std::thread thread_;
};

TEST_F(StandIns, ReadForWhoHasBeenGivenUp) {
  const std::string name = "@" + token_ + ".writer.out";
  add_link("reader", "unix-listen:" + name, "unix:" + name + "?reconnect=86400", true);
  write_for("unix-listen:" + name + "?readers=1");
}

TEST_F(StandIns, ReadForEachReaderOfACommonOutput) {
  const std::string uri = "shm:" + token_ + ".writer.out";
  for (const char* reader : {"first", "second"})
    add_link(reader, uri, uri + "?reconnect=86400", true);
  write_for(uri + "?readers=2");
}

TEST_F(StandIns, ReadForWhoTakesNoCommands) {
  const std::string name = "@" + token_ + ".writer.out";
  add_link("reader", "unix-listen:" + name, "unix:" + name + "?wait=60", false);
  write_for("unix-listen:" + name + "?readers=1");
}

}  // namespace
}  // namespace hc
