// SPDX-License-Identifier: Apache-2.0
#include <hc/os/procfs.h>

#include <gtest/gtest.h>

#include <sched.h>

#include <algorithm>
#include <csignal>

#include <graph/process.h>
#include <hc/link/link.h>
#include <hc/os/wait_readable.h>

namespace hc::internal {
namespace {

using namespace std::chrono_literals;

/// A shell that has printed something.
Process ready_shell(const std::string& script) {
  auto process = Process::start({"/bin/sh", "-c", script}, Process::Capture::Output);
  HC_CHECK(process, process.error().detail);
  HC_CHECK(wait_readable(std::array{process->output()}));
  return std::move(*process);
}

TEST(ProcessLook, FindsAllThatDescends) {
  auto process = ready_shell("setsid sh -c 'echo; sleep 1000; true' & exec sleep 1000");
  const pid_t program = process.number();
  EXPECT_EQ(::kill(program, 0), 0);
  // The inner shell forks its child only after its line.
  std::vector<pid_t> all;
  while (all.size() < 3) all = descendants(process.guard_number());
  EXPECT_EQ(all.front(), program);
  EXPECT_GT(usage_of(all, true).memory, usage_of({program}, true).memory);
}

TEST(ProcessLook, SaysWhatIsUsed) {
  auto process = ready_shell("echo; while :; do :; done");
  auto all = descendants(process.guard_number());
  while (usage_of(all, false).processor < 50ms) ::sched_yield();
  auto usage = usage_of(all, true);
  EXPECT_GT(usage.memory, std::uint64_t{10} << 10);
  EXPECT_FALSE(usage.is_stopped);
  ASSERT_EQ(::kill(all[0], SIGSTOP), 0);
  while (!usage_of(all, false).is_stopped) ::sched_yield();
}

TEST(ProcessLook, SaysForHowLongAProcessorWasAwaited) {
  auto process = ready_shell("echo; while :; do :; done");
  auto all = descendants(process.guard_number());
  // On one processor with another one that never rests.
  auto other = ready_shell("echo; while :; do :; done");
  cpu_set_t first{};
  CPU_SET(static_cast<std::size_t>(::sched_getcpu()), &first);
  for (const pid_t each : {process.number(), other.number()})
    ASSERT_EQ(::sched_setaffinity(each, sizeof first, &first), 0);
  while (usage_of(all, false).waited < 50ms) ::sched_yield();
}

TEST(ProcessLook, WhoHasGoneUsesNothing) {
  auto process = ready_shell("echo");
  ASSERT_TRUE(wait_readable(std::array{process.ended()}));
  process.poll_status();
  EXPECT_TRUE(descendants(process.guard_number()).empty());
  EXPECT_EQ(usage_of({process.guard_number()}, true).memory, 0U);
}

}  // namespace
}  // namespace hc::internal
