// SPDX-License-Identifier: Apache-2.0
#include <graph/process.h>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include <array>
#include <csignal>
#include <fstream>

#include <hc/link/link.h>
#include <hc/os/procfs.h>
#include <hc/os/wait_readable.h>
#include <hc/testing/must.h>

namespace hc::internal {
namespace {

using Capture = Process::Capture;

Process shell(const std::string& script, Capture capture = Capture::Output) {
  auto process = Process::start({"/bin/sh", "-c", script}, capture);
  HC_CHECK(process, process.error().detail);
  return std::move(*process);
}

void wait_for(int descriptor) {
  std::array<int, 1> descriptors = {descriptor};
  EXPECT_TRUE(wait_readable(descriptors));
}

/// The output of a process up to `end`, or to its end.
std::string listen(const Process& process, char end = '\0') {
  std::string text;
  while (true) {
    wait_for(process.output());
    char letter = 0;
    if (::read(process.output(), &letter, 1) <= 0 || letter == end) return text;
    text += letter;
  }
}

int status_of(Process& process) {
  wait_for(process.ended());
  return process.poll_status().value_or(-1);
}

/// Whether a process exists and is not a zombie.
bool runs(pid_t process) {
  std::ifstream file("/proc/" + std::to_string(process) + "/stat");
  std::string number, name, state;
  return file >> number >> name >> state && state != "Z";
}

/// Shell code that leaves a process in a new session behind and prints its PID.
const std::string kLeaveBehind = "echo $(setsid sh -c 'echo $$; exec sleep 1000 >&2' &); ";

TEST(Process, IsHeardAndHasAStatus) {
  auto process = shell("echo said; echo dropped >&2; exit 7");
  EXPECT_EQ(listen(process), "said\n");
  EXPECT_EQ(status_of(process), 7);
  EXPECT_EQ(process.poll_status(), 7);
  auto errors = shell("echo dropped; echo said >&2; read line || exit 1", Capture::Errors);
  EXPECT_EQ(listen(errors), "said\n");
  EXPECT_EQ(status_of(errors), 1);  // standard input is empty
}

TEST(Process, WhatCannotBeExecutedIsNamed) {
  auto missing = must(Process::start({"/nowhere/program"}, Capture::Errors));
  EXPECT_EQ(listen(missing), "exec(/nowhere/program): No such file or directory\n");
  EXPECT_EQ(status_of(missing), kCannotExecute);
  EXPECT_EQ(listen(must(Process::start({"/"}, Capture::Errors))), "exec(/): Permission denied\n");
}

TEST(Process, ASignalCountsFrom128) {
  auto process = shell("kill -SEGV $$");
  EXPECT_EQ(status_of(process), 128 + SIGSEGV);
}

TEST(Process, IsAskedToEndWithItsGroup) {
  auto process = shell("trap 'wait; echo both; exit 5' TERM; sh -c 'echo; exec sleep 1000' & wait");
  EXPECT_EQ(listen(process, '\n'), "");
  process.ask_to_end();
  EXPECT_EQ(listen(process), "both\n");
  EXPECT_EQ(status_of(process), 5);
  process.ask_to_end();  // it has ended
}

TEST(Process, NothingIsLeftBehindWhenItEnds) {
  auto process = shell(kLeaveBehind + "sleep 1000 & exit 3");
  pid_t left = std::stoi(listen(process, '\n'));
  EXPECT_EQ(status_of(process), 3);
  EXPECT_FALSE(runs(left));
}

TEST(Process, NothingIsLeftBehindWhenItIsKilled) {
  auto process = shell("trap '' TERM; " + kLeaveBehind + "sleep 1000");
  pid_t left = std::stoi(listen(process, '\n'));
  EXPECT_TRUE(runs(left));
  process.kill();
  EXPECT_EQ(status_of(process), 128 + SIGKILL);
  EXPECT_FALSE(runs(left));
}

TEST(Process, NothingIsLeftBehindWhenItGoesOutOfScope) {
  pid_t left = 0;
  {
    auto process = shell(kLeaveBehind + "sleep 1000");
    auto moved = std::move(process);
    left = std::stoi(listen(moved, '\n'));
  }
  EXPECT_FALSE(runs(left));
  EXPECT_EQ(::waitpid(-1, nullptr, WNOHANG), -1);  // no child is left either
}

TEST(Process, OthersDoNotKeepAGuardAlive) {
  auto first = shell("exec sleep 1000");
  auto second = shell("exec sleep 1000");  // its guard inherits the first one's pipe at the fork
  first.kill();
  EXPECT_EQ(status_of(first), 128 + SIGKILL);
}

TEST(Process, AGuardThatIsKilledTakesItsGroupAlong) {
  auto process = shell("sleep 1000 & echo $PPID $!; wait");
  std::string numbers = listen(process, '\n');
  ASSERT_EQ(::kill(std::stoi(numbers), SIGKILL), 0);
  EXPECT_EQ(status_of(process), 128 + SIGKILL);
  EXPECT_EQ(listen(process), "");  // all writers have ended
}

/// A program whose exec hangs, as on a hanging disk.
class HungProgram {
 public:
  HungProgram() {
    std::ofstream(name_) << "#!/bin/sh\necho said\n";
    ::chmod(name_.c_str(), S_IRWXU);
    // Opening a leased file blocks until the lease is released.
    std::signal(SIGIO, SIG_IGN);
    lease_ = Descriptor(::open(name_.c_str(), O_RDONLY | O_CLOEXEC));
    HC_CHECK(::fcntl(lease_.get(), F_SETLEASE, F_WRLCK) == 0, errno);
  }
  HungProgram(const HungProgram&) = delete;
  HungProgram& operator=(const HungProgram&) = delete;
  ~HungProgram() { ::unlink(name_.c_str()); }

  /// Starts a process that hangs in exec.
  [[nodiscard]] Process start() const {
    auto process = must(Process::start({name_}, Capture::Output));
    while (::fcntl(lease_.get(), F_GETLEASE) == F_WRLCK) ::sched_yield();
    return process;
  }
  void release() { lease_.reset(); }

 private:
  const std::string name_ = ::testing::TempDir() + "hung_" + std::to_string(::getpid());
  Descriptor lease_;
};

TEST(Process, NothingIsLeftBehindWhenWeAreKilled) {
  HungProgram hung;
  int ends[2];
  ASSERT_EQ(::pipe(ends), 0);
  pid_t runner = ::fork();
  if (runner == 0) {
    ::close(ends[0]);
    auto process = shell(kLeaveBehind + "sleep 1000");
    std::string left = listen(process, '\n') + "\n";
    const auto another = hung.start();  // inherits the first one's pipe at the fork
    if (::write(ends[1], left.data(), left.size()) < 0) ::_exit(1);
    while (true) ::pause();
  }
  ::close(ends[1]);
  char left[32] = {};
  ASSERT_GT(::read(ends[0], left, sizeof left - 1), 0);
  EXPECT_TRUE(runs(std::stoi(left)));
  ASSERT_EQ(::kill(runner, SIGKILL), 0);
  ASSERT_EQ(::waitpid(runner, nullptr, 0), runner);
  // Poll, since the orphan's end cannot be waited for; the watchdog ends the test.
  while (runs(std::stoi(left))) ::sched_yield();
  ::close(ends[0]);
}

TEST(Process, AProgramOnADiskThatHangsIsNotWaitedFor) {
  HungProgram hung;
  auto process = hung.start();
  hung.release();
  EXPECT_EQ(listen(process), "said\n");
  EXPECT_EQ(status_of(process), 0);
}

TEST(Process, AProgramOnADiskThatHangsCanBeKilledAndKeepsNoOtherAlive) {
  const HungProgram hung;
  auto other = shell("exec sleep 1000");
  auto process = hung.start();
  other.kill();
  EXPECT_EQ(status_of(other), 128 + SIGKILL);
  process.kill();
  EXPECT_EQ(status_of(process), 128 + SIGKILL);
}

TEST(Process, WhatWeHaveInheritedIsInherited) {
  int ends[2];
  ASSERT_EQ(::pipe(ends), 0);
  auto process = shell("echo said >&" + std::to_string(ends[1]));
  EXPECT_EQ(status_of(process), 0);
  ::close(ends[0]);
  ::close(ends[1]);
}

TEST(Process, TooManyProcessesAreSaidInWords) {
  const pid_t limited = ::fork();
  if (limited == 0) {
    const rlimit none{0, 0};
    ::setrlimit(RLIMIT_NPROC, &none);
    constexpr uid_t kAnybody = 54321;  // root has no limit
    if (::geteuid() == 0 && ::setuid(kAnybody) != 0) ::_exit(2);
    const auto process = Process::start({"/bin/true"}, Capture::Output);
    ::_exit(!process && process.error().detail.starts_with("/bin/true cannot be started: ") ? 0
                                                                                            : 1);
  }
  int status = -1;
  ASSERT_EQ(::waitpid(limited, &status, 0), limited);
  EXPECT_EQ(status, 0);
}

TEST(Process, TooFewDescriptorsAreSaid) {
  const pid_t limited = ::fork();
  if (limited == 0) {
    rlimit limit{};
    ::getrlimit(RLIMIT_NOFILE, &limit);
    const Descriptor last(::dup(0));
    for (limit.rlim_cur = static_cast<rlim_t>(last.get()) + 1;; ++limit.rlim_cur) {
      ::setrlimit(RLIMIT_NOFILE, &limit);
      auto process = Process::start({"/bin/true"}, Capture::Output);
      if (process) ::_exit(status_of(*process));
      if (process.error().detail.find(": Too many open files") == std::string::npos) ::_exit(1);
    }
  }
  int status = -1;
  ASSERT_EQ(::waitpid(limited, &status, 0), limited);
  EXPECT_EQ(status, 0);
}

}  // namespace
}  // namespace hc::internal
