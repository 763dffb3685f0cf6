// SPDX-License-Identifier: Apache-2.0
#include <hc/os/reactor.h>

#include <gtest/gtest.h>
#include <pthread.h>
#include <sys/eventfd.h>

#include <array>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <future>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include <hc/os/descriptor.h>

namespace hc {
namespace {

using std::chrono::hours;
using std::chrono::microseconds;
using std::chrono::milliseconds;

std::unique_ptr<Watch> watch_of(int descriptor, Watch::Callback callback) {
  auto watch = std::make_unique<Watch>();
  EXPECT_TRUE(watch->start(descriptor, std::move(callback)));
  return watch;
}

Watch::TimePoint now() {
  return std::chrono::steady_clock::now();
}

/// A descriptor that is always writable, and readable after raise().
struct Event {
  Descriptor descriptor{::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)};
  void raise() const { EXPECT_EQ(::eventfd_write(descriptor.get(), 1), 0); }
};

TEST(Watch, ReportsWhatIsWantedUntilItIsNot) {
  Event event;
  std::promise<std::uint32_t> third;
  std::unique_ptr<Watch> watch;
  int count = 0;
  watch = watch_of(event.descriptor.get(), [&](std::uint32_t events) {
    if (++count < 3) return;  // level-triggered: called again
    EXPECT_TRUE(watch->want(0));
    third.set_value(events);
  });
  event.raise();
  ASSERT_TRUE(watch->want(EPOLLIN));
  EXPECT_EQ(third.get_future().get(), std::uint32_t{EPOLLIN});
  watch.reset();
  EXPECT_EQ(count, 3);
}

TEST(Watch, ReportsThatTheOtherSideHasGoneThoughOnlyErrorsAreWanted) {
  std::array<int, 2> ends{};
  ASSERT_EQ(::pipe(ends.data()), 0);
  Descriptor reader(ends[0]), writer(ends[1]);
  std::promise<std::uint32_t> told;
  std::unique_ptr<Watch> watch;
  watch = watch_of(writer.get(), [&](std::uint32_t events) {
    EXPECT_TRUE(watch->want(0));
    told.set_value(events);
  });
  ASSERT_TRUE(watch->want(EPOLLERR));
  reader.reset();
  EXPECT_EQ(told.get_future().get(), std::uint32_t{EPOLLERR});
}

TEST(Watch, CallsAtTheEarliestTimeAndOnce) {
  std::promise<std::uint32_t> first;
  std::atomic<int> count = 0;
  const auto begin = now();
  Watch::TimePoint called;
  auto watch = watch_of(-1, [&](std::uint32_t events) {
    called = now();
    if (++count == 1) first.set_value(events);
  });
  watch->call_at(begin + hours(1));
  watch->call_at(begin + milliseconds(2));
  watch->call_at(begin + hours(2));
  EXPECT_EQ(first.get_future().get(), 0U);
  std::promise<void> later;
  auto other = watch_of(-1, [&](std::uint32_t) { later.set_value(); });
  other->call_at(now() + milliseconds(1));
  later.get_future().wait();
  watch.reset();
  EXPECT_GE(called, begin + milliseconds(2));
  EXPECT_EQ(count, 1);
}

TEST(Watch, CallsInTheOrderOfTime) {
  std::vector<int> order;
  std::vector<std::unique_ptr<Watch>> watches;
  std::promise<void> all;
  for (int i = 0; i < 3; ++i)
    watches.push_back(watch_of(-1, [&, i](std::uint32_t) {
      order.push_back(i);
      if (order.size() == 3) all.set_value();
    }));
  const auto begin = now();
  std::promise<void> ready;
  auto starter = watch_of(-1, [&](std::uint32_t) {  // no other callback runs meanwhile
    for (int i : {2, 0, 1}) watches[static_cast<std::size_t>(i)]->call_at(begin + microseconds(i));
  });
  starter->call_at(begin);
  all.get_future().wait();
  EXPECT_EQ(order, (std::vector<int>{0, 1, 2}));
}

TEST(Watch, AfterItsEndTheCallbackDoesNotRun) {
  for (int i = 0; i < 200; ++i) {
    Event event;
    event.raise();
    auto counter = std::make_unique<int>(0);  // freed right after the watch
    auto watch = watch_of(event.descriptor.get(), [&](std::uint32_t) { ++*counter; });
    ASSERT_TRUE(watch->want(EPOLLIN));
    watch->call_at(now());
    if (i % 2 == 0) std::this_thread::yield();
    watch.reset();
    counter.reset();
  }
}

TEST(Watch, MayEndItselfInItsOwnCallback) {
  std::promise<void> ended;
  std::unique_ptr<Watch> watch;
  watch = watch_of(-1, [&ended, &watch](std::uint32_t) {
    auto& told = ended;  // captures stay valid until the callback returns
    watch.reset();
    told.set_value();
  });
  watch->call_at(now());
  ended.get_future().wait();
}

TEST(Watch, ACallbackMayUseAndEndOthers) {
  Event event;
  event.raise();
  std::promise<void> done;
  auto other = watch_of(event.descriptor.get(), [](std::uint32_t) {});
  auto watch = watch_of(-1, [&](std::uint32_t) {
    EXPECT_TRUE(other->want(EPOLLIN));
    other->call_at(now());
    other.reset();
    done.set_value();
  });
  watch->call_at(now());
  done.get_future().wait();
}

TEST(Watch, ItsCallbackMayHoldAnother) {
  std::shared_ptr<Watch> inner = watch_of(-1, [](std::uint32_t) {});
  auto outer = watch_of(-1, [inner](std::uint32_t) {});
  inner.reset();
  outer.reset();
}

TEST(Watch, ManyThreadsMayAskAtOnce) {
  std::atomic<int> count = 0;
  std::promise<void> all;
  std::vector<std::thread> threads;
  for (int i = 0; i < 4; ++i)
    threads.emplace_back([&] {
      for (int k = 0; k < 100; ++k) {
        std::promise<void> called;
        auto watch = watch_of(-1, [&](std::uint32_t) { called.set_value(); });
        watch->call_at(now() + microseconds(k));
        called.get_future().wait();
        ++count;
      }
    });
  for (auto& thread : threads) thread.join();
  EXPECT_EQ(count, 400);
}

TEST(Watch, ItsThreadTakesNoSignals) {
  std::promise<sigset_t> told;
  auto watch = watch_of(-1, [&](std::uint32_t) {
    sigset_t blocked;
    ::pthread_sigmask(SIG_SETMASK, nullptr, &blocked);
    told.set_value(blocked);
  });
  watch->call_at(now());
  sigset_t blocked = told.get_future().get();
  for (int signal : {SIGINT, SIGTERM, SIGPIPE, SIGCHLD, SIGALRM})
    EXPECT_EQ(::sigismember(&blocked, signal), 1) << signal;
}

TEST(Watch, AFileIsRefused) {
  Descriptor file(::fileno(std::tmpfile()));
  auto watch = watch_of(file.get(), [](std::uint32_t) {});
  EXPECT_EQ(watch->want(EPOLLOUT).error().code, Code::System);
}

}  // namespace
}  // namespace hc
