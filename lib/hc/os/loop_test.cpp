// SPDX-License-Identifier: Apache-2.0
#include <hc/os/aside.h>
#include <hc/os/loop.h>

#include <gtest/gtest.h>
#include <sys/eventfd.h>

#include <functional>
#include <string>
#include <thread>
#include <vector>

namespace hc {
namespace {

using namespace std::chrono_literals;

class LoopTest : public ::testing::Test {
 protected:
  static Descriptor event() { return Descriptor(::eventfd(1, EFD_NONBLOCK | EFD_CLOEXEC)); }

  Loop::Handle watch(const Descriptor& descriptor, Loop::Callback callback) {
    auto handle = loop_->watch(descriptor.get(), EPOLLIN, std::move(callback));
    HC_CHECK(handle, handle.error().detail);
    return std::move(*handle);
  }

  std::unique_ptr<Loop> loop_ = std::move(*Loop::make());
  std::string heard_;
};

TEST_F(LoopTest, CallsAsLongAsItIsReadable) {
  auto descriptor = event();
  auto handle = watch(descriptor, [&](auto) { heard_ += "a"; });
  ASSERT_TRUE(loop_->turn());
  ASSERT_TRUE(loop_->turn());
  EXPECT_EQ(heard_, "aa");
  handle.reset();
  auto timer = loop_->call_at({}, [&] { heard_ += "t"; });
  ASSERT_TRUE(loop_->turn());
  EXPECT_EQ(heard_, "aat");
}

TEST_F(LoopTest, TimesComeInTheirOrderAndOnce) {
  auto now = std::chrono::steady_clock::now();
  auto second = loop_->call_at(now + 2ms, [&] { heard_ += "2"; });
  auto never = loop_->call_at(now + 1h, [&] { heard_ += "3"; });
  auto first = loop_->call_at(now + 1ms, [&] { heard_ += "1"; });
  while (heard_.size() < 2) ASSERT_TRUE(loop_->turn());
  never = loop_->call_at(now, [&] { heard_ += "4"; });
  ASSERT_TRUE(loop_->turn());
  EXPECT_EQ(heard_, "124");
}

TEST_F(LoopTest, WhoEndsAnotherInACallbackIsTheLastToBeCalled) {
  auto one = event(), other = event();
  Loop::Handle first, second;
  first = watch(one, [&](auto) {
    heard_ += "1";
    first.reset();
    second.reset();
  });
  second = watch(other, [&](auto) {
    heard_ += "2";
    second.reset();
    first.reset();
  });
  ASSERT_TRUE(loop_->turn());
  EXPECT_EQ(heard_.size(), 1U);
}

TEST_F(LoopTest, AHandleMovesToAnotherDescriptor) {
  auto one = event();
  auto handle = watch(one, [&](auto) { heard_ += "a"; });
  ASSERT_TRUE(loop_->turn());
  Descriptor other(::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC));
  handle.move_to(other.get());
  one.reset();
  ASSERT_TRUE(loop_->turn(0ms));
  ASSERT_TRUE(handle.want(EPOLLIN));
  ASSERT_TRUE(loop_->turn(0ms));
  EXPECT_EQ(heard_, "a");
  ::eventfd_write(other.get(), 1);
  ASSERT_TRUE(loop_->turn());
  EXPECT_EQ(heard_, "aa");
}

TEST_F(LoopTest, ATimeThatIsCancelledLeavesTheLoopQuiet) {
  auto now = std::chrono::steady_clock::now();
  auto timer = loop_->call_at(now, [&] { heard_ += "t"; });
  timer.reset();
  EXPECT_FALSE(*wait_for(loop_->descriptor(), POLLIN, -1, now)) << "it can be nested";
}

TEST_F(LoopTest, WhatCannotBeWatchedIsAnError) {
  EXPECT_FALSE(loop_->watch(-1, EPOLLIN, [](auto) {}));
  auto descriptor = event();
  auto handle = watch(descriptor, [](auto) {});
  EXPECT_FALSE(loop_->watch(descriptor.get(), EPOLLIN, [](auto) {})) << "it is watched already";
  EXPECT_TRUE(loop_->turn());
}

TEST_F(LoopTest, PostedJobsAreDoneInTheirOrder) {
  std::thread other([&] {
    loop_->post([&] { heard_ += "1"; });
    loop_->post([&] {
      heard_ += "2";
      loop_->post([&] { heard_ += "3"; });
    });
  });
  while (heard_.size() < 2) ASSERT_TRUE(loop_->turn());
  other.join();
  EXPECT_EQ(heard_, "12") << "what a job posts waits for the next turn";
  ASSERT_TRUE(loop_->turn());
  EXPECT_EQ(heard_, "123");
}

TEST_F(LoopTest, ATimerThatIsSetLaterDoesNotHoldBackAPostedJob) {
  auto first = loop_->call_at(std::chrono::steady_clock::now() + 1h, [] {});
  loop_->post([&] { heard_ += "p"; });
  auto second = loop_->call_at(std::chrono::steady_clock::now() + 30min, [] {});
  second.reset();
  ASSERT_TRUE(loop_->turn());
  EXPECT_EQ(heard_, "p");
  EXPECT_FALSE(*wait_for(loop_->descriptor(), POLLIN, -1, std::chrono::steady_clock::now()));
}

TEST_F(LoopTest, NoJobIsLostThatManyThreadsPost) {
  constexpr int kThreads = 4, kJobs = 1000;
  int done = 0;
  std::vector<std::thread> threads;
  for (int i = 0; i < kThreads; ++i)
    threads.emplace_back([&] {
      for (int job = 0; job < kJobs; ++job) loop_->post([&] { ++done; });
    });
  while (done < kThreads * kJobs) {
    // Sets timers concurrently with post().
    auto timer = loop_->call_at(std::chrono::steady_clock::now() + 1h, [] {});
    ASSERT_TRUE(loop_->turn());
  }
  for (auto& thread : threads) thread.join();
}

TEST_F(LoopTest, WorkAsideHandsOverItsResult) {
  auto aside = run_aside(
      *loop_, [](int) { return std::string("result"); },
      [&](const std::string& result) { heard_ = result; });
  ASSERT_TRUE(aside);
  EXPECT_TRUE(aside->is_busy());
  while (heard_.empty()) ASSERT_TRUE(loop_->turn());
  EXPECT_EQ(heard_, "result");
  EXPECT_FALSE(aside->is_busy());
}

TEST_F(LoopTest, WorkAsideIsStopped) {
  auto until_stopped = [](int stop) { return *wait_for(stop, POLLIN, -1); };
  auto note = [&](bool) { heard_ += "d"; };
  Aside aside = std::move(*run_aside(*loop_, until_stopped, note));
  aside.stop();
  EXPECT_TRUE(aside.is_stopped());
  while (heard_.empty()) ASSERT_TRUE(loop_->turn());
  aside = std::move(*run_aside(*loop_, until_stopped, note));
  EXPECT_FALSE(aside.is_stopped());
  aside = Aside();
  aside = std::move(*run_aside(
      *loop_, [](int) { return true; }, note));
  while (heard_.size() < 2) ASSERT_TRUE(loop_->turn());
  EXPECT_EQ(heard_, "dd") << "the result of one that was ended before is dropped";
}

TEST_F(LoopTest, WorkAsideMayFollowWork) {
  Aside aside;
  std::function<void(int)> again = [&](int count) {
    heard_ += std::to_string(count);
    if (count < 3)
      aside = std::move(*run_aside(
          *loop_, [count](int) { return count + 1; }, again));
  };
  again(1);
  while (heard_.size() < 3) ASSERT_TRUE(loop_->turn());
  EXPECT_EQ(heard_, "123");
}

}  // namespace
}  // namespace hc
