// SPDX-License-Identifier: Apache-2.0
#include <hc/os/loop.h>

#include <gtest/gtest.h>
#include <sys/eventfd.h>

#include <string>

namespace hc::internal {
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

}  // namespace
}  // namespace hc::internal
