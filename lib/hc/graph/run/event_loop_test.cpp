// SPDX-License-Identifier: Apache-2.0
#include <hc/graph/run/event_loop.h>

#include <gtest/gtest.h>
#include <sys/eventfd.h>

#include <string>

namespace hc::internal {
namespace {

using namespace std::chrono_literals;

class EventLoopTest : public ::testing::Test {
 protected:
  static Descriptor event() { return Descriptor(::eventfd(1, EFD_NONBLOCK | EFD_CLOEXEC)); }

  EventLoop::Handle watch(const Descriptor& descriptor, EventLoop::Callback callback) {
    auto handle = loop_->watch(descriptor.get(), EPOLLIN, std::move(callback));
    HC_CHECK(handle, handle.error().detail);
    return std::move(*handle);
  }

  std::unique_ptr<EventLoop> loop_ = std::move(*EventLoop::make());
  std::string heard_;
};

TEST_F(EventLoopTest, CallsAsLongAsItIsReadable) {
  auto descriptor = event();
  auto handle = watch(descriptor, [&] { heard_ += "a"; });
  ASSERT_TRUE(loop_->turn());
  ASSERT_TRUE(loop_->turn());
  EXPECT_EQ(heard_, "aa");
  handle.reset();
  auto timer = loop_->call_at({}, [&] { heard_ += "t"; });
  ASSERT_TRUE(loop_->turn());
  EXPECT_EQ(heard_, "aat");
}

TEST_F(EventLoopTest, TimesComeInTheirOrderAndOnce) {
  auto now = std::chrono::steady_clock::now();
  auto second = loop_->call_at(now + 2ms, [&] { heard_ += "2"; });
  auto never = loop_->call_at(now + 1h, [&] { heard_ += "3"; });
  auto first = loop_->call_at(now + 1ms, [&] { heard_ += "1"; });
  while (heard_.size() < 2) ASSERT_TRUE(loop_->turn());
  never = loop_->call_at(now, [&] { heard_ += "4"; });
  ASSERT_TRUE(loop_->turn());
  EXPECT_EQ(heard_, "124");
}

TEST_F(EventLoopTest, WhoEndsAnotherInACallbackIsTheLastToBeCalled) {
  auto one = event(), other = event();
  EventLoop::Handle first, second;
  first = watch(one, [&] {
    heard_ += "1";
    first.reset();
    second.reset();
  });
  second = watch(other, [&] {
    heard_ += "2";
    second.reset();
    first.reset();
  });
  ASSERT_TRUE(loop_->turn());
  EXPECT_EQ(heard_.size(), 1U);
}

TEST_F(EventLoopTest, WhatCannotBeWatchedIsAnError) {
  EXPECT_FALSE(loop_->watch(-1, EPOLLIN, [] {}));
  auto descriptor = event();
  auto handle = watch(descriptor, [] {});
  EXPECT_FALSE(loop_->watch(descriptor.get(), EPOLLIN, [] {})) << "it is watched already";
  EXPECT_TRUE(loop_->turn());
}

}  // namespace
}  // namespace hc::internal
