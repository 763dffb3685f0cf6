// SPDX-License-Identifier: Apache-2.0
// A graph whose file is edited while it runs.
#include <fcntl.h>
#include <unistd.h>

#include <graph/run/live_change_test.h>

namespace hc {
namespace {

/// A running graph with a file.
class LiveFile : public LiveChange {
 protected:
  LiveFile() {
    write();
    files_ = {file_};
  }
  ~LiveFile() override { remove(); }

  void write() const { ::close(::open(file_.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600)); }
  void remove() const { ::unlink(file_.c_str()); }

  const std::string file_ = ::testing::TempDir() + token_ + ".toml";
};

TEST_F(LiveFile, AnEditedFileIsReadAnew) {
  add("a");
  on_line_ = [&](std::string_view line) {
    if (line == "a: started") write();
    if (line == "graph: keeping the running version") {
      EXPECT_TRUE(was_reloaded());
      plan_next(plan_);
      write();
    }
    if (line == "graph: unchanged") {
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
  EXPECT_TRUE(logged("graph: one problem"));
  EXPECT_TRUE(logged("graph: another"));
  EXPECT_EQ(count("a: started"), 1);
}

TEST_F(LiveFile, AnotherEditTakesThePlaceOfTheOneThatIsRead) {
  add("a");
  int plans = 0;
  plans_ = [&](int stop) {
    if (++plans > 1) return plan_next(plan_);
    write();
    await(stop);
  };
  on_line_ = [&](std::string_view line) {
    if (line == "a: started") write();
  };
  stop_at("graph: unchanged");
  ASSERT_TRUE(run());
  EXPECT_EQ(plans, 2);
  EXPECT_FALSE(logged("graph: keeping the running version"));
}

TEST_F(LiveFile, AFileThatIsTakenAwayIsLoggedOnce) {
  add("a");
  plan_next(plan_);
  const std::string is_gone = "graph: " + file_ + " has been removed; keeping the running version";
  on_line_ = [&](std::string_view line) {
    if (line == "a: started") remove();
    if (line != is_gone) return;
    write();
    remove();
  };
  int states = 0;
  options_.state = [&](const GraphState&) {
    // By the second state, the runner has noticed that the file was there and was removed again.
    if (logged(is_gone) && ++states == 3) write();
  };
  stop_at("graph: unchanged");
  ASSERT_TRUE(run());
  EXPECT_EQ(lines_,
            (Lines{"a: started", is_gone, "graph: unchanged", "graph: stopping", "a: ended"}));
}

}  // namespace
}  // namespace hc
