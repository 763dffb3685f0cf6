// SPDX-License-Identifier: Apache-2.0
// Commands to modules when their graph changes.
#include <graph/run/live_change_test.h>

#include <memory>

namespace hc {
namespace {

/// Receives the commands for a module.
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

using LiveCommands = LiveChange;

TEST_F(LiveCommands, ReachAModuleThatListens) {
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
    change_to(other);
    EXPECT_EQ(first.next(), "unlink out left=shm:t.left?readers=1");
    EXPECT_EQ(first.next(), "set rate=10");
    EXPECT_EQ(first.next(), "link out left=shm:t.own?readers=1&rate=5");
    EXPECT_EQ(first.next(), "route left=shm:t.own?readers=1&rate=5 to=5");
    EXPECT_EQ(second.next(), "unlink in image=shm:t.left?reconnect=86400");
    EXPECT_EQ(second.next(), "link in image=shm:t.own?reconnect=86400");
  });
  ASSERT_TRUE(run());
  EXPECT_EQ(count("camera: started"), 1);
  EXPECT_TRUE(logged("camera: set rate=10"));
}

TEST_F(LiveCommands, AreReportedWhereAModuleRefusesOne) {
  add("camera");
  stop_at("camera: command \"set rate=-1\": too small");
  thread_ = std::thread([&] {
    auto reports = open_sink(*parse_uri(peer_of(plan_.modules[0].manage_uri) + "?wait=60"));
    HC_CHECK(reports, reports.error().detail);
    Message message = make_log(Level::Warning, "command \"set rate=-1\": too small");
    message.header.src = 5;
    EXPECT_TRUE((*reports)->send(message));
  });
  ASSERT_TRUE(run());
}

TEST_F(LiveCommands, WhoComesToListenGetsTheDifference) {
  auto& camera = add("camera");
  camera.parameters = {{"rate", "0"}};
  camera.ends = {{true, "in", "unix:@a?reconnect=1", ""}};
  beside([&] {
    Plan other = plan_;
    for (int i = 1; i <= 1100; ++i) {
      other.modules[0].parameters["rate"] = std::to_string(i);
      other.modules[0].ends[0].uri = "unix:@" + std::to_string(i) + "?reconnect=1";
      change_to(other);
    }
    EXPECT_EQ(ask({"add x p"}), Lines{"ok"});  // the same plan again
    Listener module(plan_.modules[0]);
    EXPECT_EQ(module.next(), "unlink in in=unix:@a?reconnect=1");
    EXPECT_EQ(module.next(), "set rate=1100");
    EXPECT_EQ(module.next(), "link in in=unix:@1100?reconnect=1");
    other.modules[0].parameters["rate"] = "0";
    change_to(other);
    EXPECT_EQ(module.next(), "set rate=0");
  });
  ASSERT_TRUE(run());
  EXPECT_EQ(count("camera: started"), 1);
  EXPECT_EQ(count("graph: unchanged"), 1);
}

TEST_F(LiveCommands, AnotherProgramMayTakeCommandsWhereTheFirstDidNot) {
  add("a");
  Plan with = plan_;
  with.modules[0].parameters = {{"rate", "1"}};
  plan_.modules[0].control_uri.clear();
  const Plan without = plan_;
  stop_at("a: started", 3);
  thread_ = std::thread([&] {
    change_to(with);
    { Listener listener(with.modules[0]); }
    change_to(without);
  });
  auto report = run();
  ASSERT_TRUE(report);
  EXPECT_EQ(count("a: started"), 3);
}

TEST_F(LiveCommands, AReaderLearnsThatItsWriterHasEnded) {
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

}  // namespace
}  // namespace hc
