// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <map>
#include <set>
#include <thread>

#include <graph/run/running_test.h>
#include <hc/link/link.h>
#include <hc/mtp/matrix_view.h>
#include <hc/mtp/rows.h>
#include <hc/testing/must.h>

namespace hc {
namespace {

using namespace std::chrono_literals;

/// Sends reports as a module does, on the thread of on_line_.
class Reporter {
 public:
  explicit Reporter(const PlannedModule& module)
      : sink_(must(open_sink(*parse_uri(peer_of(module.manage_uri))))) {}
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
    std::copy(numbers.begin(), numbers.end(), view<std::int64_t>(draft).numbers().begin());
    report(src, std::move(draft).finish());
  }

 private:
  std::unique_ptr<Sink> sink_;
};

/// Modules that end or hang.
class Supervision : public Run {
 protected:
  Supervision() {
    options_.limits.restarts.first_delay = 1ms;
    options_.limits.restarts.longest_delay = 2ms;
  }

  PlannedModule& add(const std::string& name, const std::string& script = "exec sleep 1000",
                     Restart restart = Restart::Failure) {
    auto& module = Run::add(name, script);
    module.restart = restart;
    return module;
  }
  void link(const std::string& from, const std::string& to, const std::string& sender = "",
            const std::string& reader = "") {
    plan_.links.push_back({from, to, sender, reader, "all", {}, false});
  }
  /// The PID printed by a module; 0 for any other line.
  static pid_t process_in(std::string_view line) {
    const std::string text(line.substr(std::min(line.size(), line.find(": ") + 2)));
    return std::atoi(text.c_str());
  }
  /// Reports on behalf of a started module.
  Reporter& reporter(const std::string& name) {
    auto& reporter = reporters_[name];
    if (!reporter)
      reporter =
          std::make_unique<Reporter>(*std::ranges::find(plan_.modules, name, &PlannedModule::name));
    return *reporter;
  }
  static const ModuleState& module(const RunReport& report, const std::string& name) {
    return *std::ranges::find(report.state.modules, name, &ModuleState::name);
  }

  std::map<std::string, std::unique_ptr<Reporter>> reporters_;
};

TEST_F(Supervision, OneThatIsKilledComesBackAndTheOthersGoOn) {
  add("a", "echo $$ >&2; exec sleep 1000");
  add("b");
  on_line_ = [this](std::string_view line) {
    const pid_t process = process_in(line);
    if (process == 0) return;
    if (count("a: started") == 3) return stop();
    ASSERT_EQ(::kill(process, SIGKILL), 0);
  };
  auto report = must(run());
  EXPECT_EQ(count("a: killed by signal 9; restarting"), 2);
  EXPECT_EQ(count("b: started"), 1);
  EXPECT_EQ(module(report, "a").restarts, 2);
  EXPECT_EQ(module(report, "b").restarts, 0);
}

TEST_F(Supervision, OneThatEndsBeforeItsCutOffWriterDoesIsRestarted) {
  add("first", "echo $$ >&2; exec sleep 1000");
  add("second");
  add("third", "trap 'exit 0' USR1; echo $$ >&2; while :; do sleep 1000 & wait; done");
  link("first.out", "second.in");
  link("second.out", "third.in");
  std::map<std::string, pid_t> pids;
  on_line_ = [&](std::string_view line) {
    const auto name = std::string(line.substr(0, line.find(':')));
    const pid_t process = process_in(line);
    if (process > 0 && pids.emplace(name, process).second && pids.size() == 2)
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
  EXPECT_EQ(lines_.back(),
            "a: failed with status 3; failed permanently after 13 starts; hc graph restart a "
            "starts it again");
  EXPECT_EQ(module(report, "a").status, ModuleStatus::GivenUp);
  EXPECT_EQ(module(report, "a").exit, 3);
}

TEST_F(Supervision, BadArgumentsWouldBeBadAgain) {
  add("a", "exit 2");
  must(run());
  EXPECT_EQ(lines_, (std::vector<std::string>{
                        "a: started",
                        "a: failed with status 2 (bad arguments); failed permanently; "
                        "hc graph restart a starts it again"}));
}

TEST_F(Supervision, OneThatSendsNoReportsIsSeenToBeStopped) {
  add("a", "echo $$ >&2; exec sleep 1000");
  pid_t process = 0;
  on_line_ = [&](std::string_view line) {
    if (process == 0 && (process = process_in(line)) > 0) ::kill(process, SIGSTOP);
    if (line == "a: unresponsive: stopped by a signal") ::kill(process, SIGCONT);
    if (line == "a: resumed") stop();
  };
  must(run());
  EXPECT_EQ(count("a: unresponsive: stopped by a signal"), 1);
}

TEST_F(Supervision, AlwaysIsAfterAGoodEndToo) {
  add("a", "exit 0", Restart::Always);
  stop_at("a: started", 7);
  must(run());
  EXPECT_EQ(count("a: ended; restarting"), 4);
}

TEST_F(Supervision, AStoppingGraphStartsNothingAgain) {
  options_.limits.restarts.first_delay = options_.limits.restarts.longest_delay = 1h;
  add("a", "exit 3");
  add("b");
  on_line_ = [this](std::string_view line) {
    if (line.find("restarting in") != std::string_view::npos) stop();
  };
  auto report = must(run());
  EXPECT_TRUE(report.stopped);
  EXPECT_EQ(module(report, "a").status, ModuleStatus::Ended);
}

TEST_F(Supervision, WhoDoesNotEndWhenAskedToIsKilled) {
  options_.limits.grace = 10ms;
  add("a", "trap '' TERM; echo ready >&2; while :; do sleep 1000; done");
  stop_at("a: ready");
  must(run());
  EXPECT_TRUE(logged("a: killed by signal 9"));
}

TEST_F(Supervision, AQuietOnePrintsItsLastLinesWhenItFails) {
  options_.with_module_lines = false;
  add("a", "seq 1 30 >&2; exit 2");
  ASSERT_TRUE(run());
  ASSERT_EQ(lines_.size(), 22U);
  EXPECT_EQ(lines_[1], "a: 11");
  EXPECT_EQ(lines_[20], "a: 30");
}

TEST_F(Supervision, OneThatIsStoppedIsShownAsStalledAndGoesOn) {
  options_.limits.stall = 50ms;
  add("a", "kill -STOP $$; exec sleep 1000");
  on_line_ = [&](std::string_view line) {
    if (line == "a: started") reporter("a").count(1);
    if (line == "a: unresponsive: stopped by a signal" || line == "a: unresponsive: busy")
      reporter("a").count(2);
    if (line == "a: resumed") stop();
  };
  must(run());
  EXPECT_TRUE(logged("a: resumed"));
}

TEST_F(Supervision, OneThatWaitsForAReaderIsNotStalledUnlessItIsStopped) {
  options_.limits.stall = 50ms;
  add("a", "echo $$ >&2; exec sleep 1000");
  pid_t process = 0;
  on_line_ = [&](std::string_view line) {
    if (line == "a: started") reporter("a").publish_state(true);
    if (process == 0) process = process_in(line);
    if (line == "a: unresponsive: busy") stop();
  };
  std::vector<std::string> seen;
  options_.state = [&](const GraphState& state) {
    const auto& detail = state.modules.at(0).detail;
    if (detail.empty() || process == 0 || (!seen.empty() && seen.back() == detail)) return;
    seen.push_back(detail);
    const bool is_stopped = state.modules.at(0).status == ModuleStatus::Stalled;
    if (is_stopped || seen.size() == 1) ::kill(process, is_stopped ? SIGCONT : SIGSTOP);
    if (seen.size() == 3) reporter("a").publish_state(false);
  };
  must(run());
  EXPECT_EQ(seen, (std::vector<std::string>{"blocked: waits for its reader", "stopped by a signal",
                                            "blocked: waits for its reader"}));
}

TEST_F(Supervision, OneThatHangsIsKilledAndRestarted) {
  add("hung").hang = 1s;
  add("stopped").hang = 1s;
  add("waits").hang = 1s;  // for a reader: spared
  add("patient");
  std::set<std::string> again;
  on_line_ = [&](std::string_view line) {
    const std::string name(line.substr(0, line.find(':')));
    if (line.ends_with(": started")) {
      if (reporters_.erase(name) > 0) again.insert(name);
      reporter(name).publish_state(name == "waits");
    }
    if (again == std::set<std::string>{"hung", "stopped"}) stop();
  };
  options_.state = [&](const GraphState& state) {
    for (const auto& module : state.modules)
      if (module.name == "stopped" && module.process > 0 && !again.contains("stopped"))
        ::kill(module.process, SIGSTOP);
  };
  auto report = must(run());
  EXPECT_TRUE(logged("hung: hung for 1 s; restarting"));
  EXPECT_TRUE(logged("stopped: hung for 1 s; restarting"));
  EXPECT_EQ(module(report, "hung").restarts, 1);
  EXPECT_EQ(module(report, "waits").restarts, 0);
  EXPECT_EQ(module(report, "patient").restarts, 0);
}

TEST_F(Supervision, OneThatHangsBeforeItsFirstReportIsKilledAndRestarted) {
  options_.limits.first_report = 1s;
  for (const std::string name : {"hung", "stopped", "silent", "stopped_silent"}) {
    auto& module = add(name);
    module.hang = 1s;
    if (!name.ends_with("silent")) module.control_uri = "unix-listen:@" + token_ + "." + name;
  }
  options_.state = [&](const GraphState& state) {
    for (const auto& module : state.modules)
      if (module.name.starts_with("stopped") && module.process > 0 && module.restarts == 0)
        ::kill(module.process, SIGSTOP);
  };
  std::set<std::string> hung;
  on_line_ = [&](std::string_view line) {
    if (line.ends_with(": hung for 1 s; restarting")) hung.emplace(line, 0, line.find(':'));
    if (hung.size() == 3) stop();
  };
  must(run());
  EXPECT_EQ(hung, (std::set<std::string>{"hung", "stopped", "stopped_silent"}));
}

TEST_F(Supervision, OneThatLoadsForLongerThanItsHangIsLeftAlone) {
  options_.limits.first_report = 1h;
  auto& slow = add("slow");
  slow.hang = 1s;
  slow.control_uri = "unix-listen:@" + token_ + ".slow";
  add("hung").hang = 3s;
  on_line_ = [&](std::string_view line) {
    if (line != "hung: started") return;
    if (!reporters_.empty()) return stop();
    reporter("hung").publish_state(false);
  };
  auto report = must(run());
  EXPECT_TRUE(logged("hung: hung for 3 s; restarting"));
  EXPECT_EQ(module(report, "slow").restarts, 0);
}

TEST_F(Supervision, OneThatWaitsSaysForWhomSinceWhen) {
  const std::string uri = "unix-listen:@" + token_ + ".a.out";
  add("a").ends = {{false, "out", uri, ""}};
  add("b").ends = {{true, "in", peer_of(uri), ""}};
  link("a.out", "b.in", uri, peer_of(uri));
  on_line_ = [&](std::string_view line) {
    if (line == "a: started") reporter("a").publish_state(true);
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
  link("a.out", "tcp:1", module.ends[0].uri);
  on_line_ = [&](std::string_view line) {
    if (line == "a: started") Reporter(plan_.modules[0]).count(5);
  };
  auto report = must(run());
  EXPECT_EQ(report.state.links.at(0).traffic.messages, 65U);
}

TEST_F(Supervision, TheRateOfALinkIsOfWhatItsReaderTakes) {
  const std::string uri = "unix-listen:@" + token_ + ".out";
  add("writer").ends = {{false, "out", uri, ""}};
  add("reader").ends = {{true, "in", peer_of(uri), ""}};
  link("writer.out", "reader.in", uri, peer_of(uri));
  on_line_ = [&](std::string_view line) {
    if (line.ends_with(": started")) reporter(std::string(line.substr(0, line.find(':'))));
  };
  LinkState link;
  std::int64_t count = 0;
  options_.state = [&](const GraphState& state) {
    link = state.links.at(0);
    if (link.per_second > 0) return stop();
    if (reporters_.size() < 2) return;
    count += 9;
    for (const auto& [name, bytes] : {std::pair("writer", 10), {"reader", 7}})
      reporter(name).report(1, std::array<std::int64_t, 4>{count, count * bytes, 0, 1});
  };
  must(run());
  EXPECT_DOUBLE_EQ(link.bytes_per_second, 7 * link.per_second);
  EXPECT_EQ(link.traffic.bytes, 10 * link.traffic.messages);
}

TEST_F(Supervision, AReportThatIsTooLargeIsNotTaken) {
  add("a");
  options_.limits.stall = 1ms;  // shows that the next report has been taken
  std::thread reporting;
  on_line_ = [&](std::string_view line) {
    if (line == "a: started")
      reporting = std::thread([&module = plan_.modules[0]] {
        auto large = make_rows(std::array{"large=" + std::string(std::size_t{2} << 20, 'x')});
        large.header.src = 3;
        // It may be disconnected before all is sent.
        static_cast<void>((*open_sink(*parse_uri(peer_of(module.manage_uri))))->send(large));
        Reporter(module).count(1);
      });
    if (line == "a: unresponsive: busy") stop();
  };
  auto report = run();
  reporting.join();
  ASSERT_TRUE(report) << report.error().detail;
  EXPECT_TRUE(module(*report, "a").parameters.empty());
}

void expect_all_ended(const RunReport& report) {
  EXPECT_FALSE(report.stopped);
  for (const auto& each : report.state.modules) EXPECT_EQ(each.status, ModuleStatus::Ended);
}

TEST_F(Supervision, AModuleAllOfWhoseReadersHaveEndedEnds) {
  add("writer");
  add("between");
  add("reader", "exit 0");
  link("writer.out", "between.in");
  link("between.out", "reader.in");
  expect_all_ended(must(run()));
}

TEST_F(Supervision, AModuleThatEndsTheGraphTakesAllOthersWithIt) {
  add("score", "exit 0").ends_graph = true;
  add("writer");
  add("reader");
  link("writer.out", "reader.in");
  link("reader.out", "writer.in");
  expect_all_ended(must(run()));
}

TEST_F(Supervision, WhoFailsThoughNobodyNeedsItHasFailed) {
  add("writer", "trap 'exit 7' TERM; echo ready >&2; while :; do sleep 0.01; done", Restart::Never);
  add("reader", "trap 'exit 0' TERM; echo $$ >&2; while :; do sleep 0.01; done");
  link("writer.out", "reader.in");
  pid_t reader = 0;
  on_line_ = [&](std::string_view line) {
    if (reader == 0) reader = process_in(line);
    if (reader > 0 && logged("writer: ready")) ::kill(reader, SIGTERM);
  };
  EXPECT_EQ(refused(run()).detail, "module writer: failed with status 7");
}

/// The test writes on behalf of the module "writer", and waits for all `readers` of the output: the
/// modules, or the drains that replace them.
class StandIns : public Supervision {
 protected:
  void write_for(const std::string& sender_uri) {
    add("writer");
    on_line_ = [this, sender_uri](std::string_view line) {
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
                bool reconnects) {
    add(reader, "exit 2");
    plan_.links.push_back({"writer.out", reader + ".in", uri, in, "all", {}, reconnects});
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
