// SPDX-License-Identifier: Apache-2.0
#include <hc/os/program.h>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <latch>
#include <string>
#include <thread>
#include <vector>

namespace hc {
namespace {

/// Evaluates a condition in a child process, since signal handlers stay installed.
template <typename Function>
bool holds_in_child(Function function) {
  const pid_t child = ::fork();
  if (child == 0) ::_exit(function() ? 1 : 0);
  int status = 0;
  EXPECT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status));
  return WEXITSTATUS(status) == 1;
}

bool is_stopped_by(int signal, bool is_ignored) {
  return holds_in_child([&] {
    std::signal(signal, is_ignored ? SIG_IGN : SIG_DFL);
    static_cast<void>(stop_descriptor());
    std::raise(signal);
    std::raise(signal);  // as `timeout` does
    return stop_requested();
  });
}

TEST(Program, AClosedTerminalStopsItUnlessThatIsIgnored) {
  EXPECT_TRUE(is_stopped_by(SIGINT, false));
  EXPECT_TRUE(is_stopped_by(SIGHUP, false));
  EXPECT_FALSE(is_stopped_by(SIGHUP, true));
}

TEST(Program, ASignalIsNoticedByThoseWhoWaitAndThoseWhoAsk) {
  EXPECT_TRUE(holds_in_child([] {
    if (stop_requested()) return false;
    const int stop = stop_descriptor();
    if (stop_descriptor() != stop) return false;
    pollfd waiting{stop, POLLIN, 0};
    if (::poll(&waiting, 1, 0) != 0) return false;
    std::raise(SIGTERM);
    return stop_requested() && ::poll(&waiting, 1, 0) == 1;
  }));
}

TEST(Program, ThreadsThatAskAtOnceGetOneDescriptor) {
  const auto all_get_one = [] {
    constexpr int kThreads = 8;
    std::latch ready(kThreads);
    std::array<int, kThreads> got{};
    {
      std::vector<std::jthread> threads;
      threads.reserve(kThreads);
      for (int& stop : got)
        threads.emplace_back([&ready, &stop] {
          ready.arrive_and_wait();
          stop = stop_descriptor();
        });
    }
    return std::all_of(got.begin(), got.end(), [&](int stop) { return stop == got[0]; });
  };
  for (int i = 0; i < 100; ++i) ASSERT_TRUE(holds_in_child(all_get_one)) << i;
}

TEST(WriteAll, WaitsForASlowReader) {
  int ends[2];
  ASSERT_EQ(::pipe2(ends, O_NONBLOCK), 0);
  std::string text(1'000'000, 'x'), got;
  std::thread reader([&] {
    char piece[4096];
    while (got.size() < text.size()) {
      pollfd readable{ends[0], POLLIN, 0};
      ::poll(&readable, 1, -1);
      ssize_t size = ::read(ends[0], piece, sizeof piece);
      if (size > 0) got.append(piece, static_cast<std::size_t>(size));
    }
  });
  EXPECT_TRUE(write_all(ends[1], text));
  reader.join();
  EXPECT_EQ(got, text);
  ::close(ends[0]);
  static_cast<void>(stop_descriptor());  // SIGPIPE is ignored from here on
  EXPECT_EQ(write_all(ends[1], text).error().code, Code::Closed);
  ::close(ends[1]);
}

TEST(WriteAll, OtherErrorsAreReported) {
  int full = ::open("/dev/full", O_WRONLY);
  ASSERT_GE(full, 0);
  EXPECT_EQ(write_all(full, "x").error().text(), "System: write: No space left on device");
  ::close(full);
}

}  // namespace
}  // namespace hc
