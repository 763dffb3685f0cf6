// SPDX-License-Identifier: Apache-2.0
#include <graph/run.h>

#include <fcntl.h>
#include <sys/stat.h>

#include <csignal>

#include <graph/run/running_test.h>
#include <hc/testing/must.h>

namespace hc {
namespace {

TEST_F(Run, LinesHaveTheModulesName) {
  add("a", "echo hello >&2; echo 'a: myself' >&2; echo; printf 'to the end' >&2");
  auto report = must(run());
  EXPECT_FALSE(report.stopped);
  EXPECT_EQ(lines_, (std::vector<std::string>{"a: started", "a: hello", "a: myself",
                                              "a: to the end", "a: ended"}));
}

TEST_F(Run, AFailureEndsTheOthers) {
  add("a", "exec sleep 1000");
  add("b", "exit 3");
  const auto report = refused(run());
  EXPECT_EQ(report.code, Code::Closed);
  EXPECT_EQ(report.detail, "module b: failed with status 3");
  EXPECT_TRUE(logged("b: failed with status 3"));
  EXPECT_TRUE(logged("a: ended"));  // by SIGTERM, which it did not catch
}

TEST_F(Run, ASignalIsNamed) {
  add("a", "kill -KILL $$");
  EXPECT_EQ(refused(run()).detail, "module a: killed by signal 9");
  EXPECT_TRUE(logged("a: killed by signal 9"));
}

TEST_F(Run, AMissingProgramIsNamed) {
  add("a", "exec sleep 1000");
  add("b", "");
  plan_.modules[1].program = "/nowhere/program";
  EXPECT_EQ(refused(run()).detail, "module b: failed with status 127");
  EXPECT_TRUE(logged("b: exec(/nowhere/program): No such file or directory"));
}

TEST_F(Run, AFloodOfLinesDoesNotKeepItFromStopping) {
  // The module is always one line ahead of the reader.
  std::string path = ::testing::TempDir() + token_;
  ASSERT_EQ(::mkfifo(path.c_str(), 0600), 0);
  add("a", "echo flood >&2; exec 3>" + path + "; while echo flood >&2; do echo >&3; done");
  stop_at("a: flood");
  Descriptor fifo;
  on_line_ = [&](std::string_view line) {
    if (line != "a: flood") return;
    if (!fifo) fifo = Descriptor(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
    char letter = 0;
    EXPECT_GE(::read(fifo.get(), &letter, 1), 0);
  };
  auto report = run();
  ::unlink(path.c_str());
  ASSERT_TRUE(report) << report.error().detail;
  EXPECT_TRUE(report->stopped);
}

TEST_F(Run, WhoHoldsStandardErrorOpenIsNotWaitedFor) {
  // The outer shell continues when the sleep has closed standard output.
  add("a", "pid=$(setsid sh -c 'echo $$; exec sleep 1000 >&2' &); echo $pid >&2");
  must(run());
  ASSERT_EQ(lines_.size(), 3U);
  EXPECT_EQ(lines_[2], "a: ended");
  EXPECT_EQ(::kill(std::stoi(lines_[1].substr(3)), 0), -1) << "it has been left";
}

TEST_F(Run, LastWordsAreHeard) {
  constexpr int kLines = 8000;  // about 40 kB, still in the pipe when it has ended
  add("a", "seq 1 " + std::to_string(kLines) + " >&2");
  must(run());
  EXPECT_EQ(lines_.size(), kLines + 2U);
  EXPECT_TRUE(logged("a: 8000"));
}

}  // namespace
}  // namespace hc
