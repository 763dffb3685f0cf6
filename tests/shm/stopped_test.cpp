// SPDX-License-Identifier: Apache-2.0
// A reader of `shm:NAME` that is stopped, as by a debugger, while messages continue: nobody waits
// for it, it takes no memory, and afterwards it has the newest message at once.
// bench/stopped_reader measures the same for a minute.
#include <gtest/gtest.h>

#include <csignal>
#include <cstdio>

#include <hc/link/shm/layout.h>

#include "child.h"

namespace hc::testing {
namespace {

constexpr std::int64_t kMemory = std::int64_t{64} << 20;

struct End {
  std::int64_t received = 0, dropped_newer = 0, last = 0;
};

End end_of(Child& reader) {
  End end;
  std::string line = reader.line();
  EXPECT_EQ(
      std::sscanf(line.c_str(), "end %ld %ld %ld", &end.received, &end.dropped_newer, &end.last), 3)
      << line;
  return end;
}

class ShmStopped : public ::testing::TestWithParam<const char*> {};

TEST_P(ShmStopped, DisturbsNobodyAndLosesWhatIsCounted) {
  const std::string name = "shm:stopped-" + std::to_string(::getpid());
  Child publisher({"publisher", name + "?readers=2", "1", "0", GetParam()});
  Child steady({"reader", name + "?wait=20", "gapless", "2"});
  Child stopped({"reader", name + "?wait=20&keep=latest", "newest", "2"});
  stopped.first_behind(0);
  stopped.freeze();
  // A message may have been on its way to it; one that far behind was not.
  const auto behind = steady.first_behind(0) + 2 * static_cast<std::int64_t>(internal::kCells);
  std::int64_t newest = 0;
  for (std::int64_t more = 1000; more <= 10'000; more += 1000) {
    newest = steady.first_behind(behind + more);
    EXPECT_LE(publisher.memory_made(), kMemory);
  }
  EXPECT_GT(publisher.memory_made(), 0);
  stopped.signal(SIGCONT);
  EXPECT_GE(stopped.first_behind(behind), newest);
  auto sent = publisher.finish();
  ASSERT_TRUE(sent.starts_with("sent ")) << sent;
  const auto count = std::stoll(sent.substr(5));
  auto all = end_of(steady), some = end_of(stopped);
  EXPECT_EQ(all.received, count);
  EXPECT_EQ(some.received + some.dropped_newer, count);
  EXPECT_GE(some.dropped_newer, 10'000);
  EXPECT_EQ(some.last, all.last);
  steady.finish();
  stopped.finish();
}

INSTANTIATE_TEST_SUITE_P(Sizes, ShmStopped, ::testing::Values("mixed", "24", "4096"),
                         [](const auto& test) { return "of_" + std::string(test.param); });

}  // namespace
}  // namespace hc::testing
