// SPDX-License-Identifier: Apache-2.0
#include <hc/link/wait_set.h>

#include <fcntl.h>
#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <string>

#include <hc/link/shm/shm_test.h>
#include <hc/os/event.h>
#include <hc/testing/must.h>

namespace hc::testing {
namespace {

using std::chrono::nanoseconds;
using std::chrono::seconds;

constexpr nanoseconds kNow{0};
constexpr seconds kLong{60};

class WaitSetTest : public ::testing::Test {
 protected:
  /// Waits for the two events alone.
  bool wait(nanoseconds timeout) {
    const std::array descriptors = {first_.descriptor(), second_.descriptor()};
    return must(waits_.wait({}, descriptors, timeout));
  }
  [[nodiscard]] bool was_first() const { return waits_.was_readable(first_.descriptor()); }
  [[nodiscard]] bool was_second() const { return waits_.was_readable(second_.descriptor()); }

  const Event first_ = must(Event::make()), second_ = must(Event::make());
  WaitSet waits_;
};

TEST_F(WaitSetTest, TellsWhichDescriptorsAreReadable) {
  EXPECT_FALSE(wait(kNow));
  EXPECT_FALSE(was_first() || was_second());
  second_.raise();
  EXPECT_TRUE(wait(kLong));
  EXPECT_TRUE(!was_first() && was_second());
  first_.raise();
  EXPECT_TRUE(wait(kLong));
  EXPECT_TRUE(was_first() && was_second());
  second_.clear();
  EXPECT_TRUE(wait(kLong));
  EXPECT_TRUE(was_first() && !was_second());
  first_.clear();
  EXPECT_FALSE(wait(kNow));
  EXPECT_FALSE(was_first() || was_second());
}

TEST_F(WaitSetTest, ADescriptorThatIsNoLongerNamedWakesNobody) {
  first_.raise();
  EXPECT_TRUE(wait(kLong));
  EXPECT_FALSE(must(waits_.wait({}, std::array{second_.descriptor(), -1}, kNow)));
  EXPECT_FALSE(was_first());
  EXPECT_FALSE(must(waits_.wait({}, {}, kNow)));
  EXPECT_TRUE(wait(kLong));
  EXPECT_TRUE(was_first());
}

TEST_F(WaitSetTest, ADescriptorThatIsOpenedAgainWithItsNumberIsNoticed) {
  for (int i = 0; i < 3; ++i) {
    first_.raise();
    EXPECT_TRUE(wait(kLong));
    first_.clear();
    EXPECT_FALSE(wait(kNow));
    const Event other = must(Event::make());
    ASSERT_EQ(::dup2(other.descriptor(), first_.descriptor()), first_.descriptor());
    other.raise();
    EXPECT_TRUE(wait(kLong));
    EXPECT_TRUE(was_first());
    other.clear();
  }
}

TEST_F(WaitSetTest, AFileIsAlwaysReadable) {
  const Descriptor file(::open("/proc/self/exe", O_RDONLY | O_CLOEXEC));
  const std::array descriptors = {file.get(), first_.descriptor()};
  for (int i = 0; i < 2; ++i) {
    EXPECT_TRUE(must(waits_.wait({}, descriptors, kLong)));
    EXPECT_TRUE(waits_.was_readable(file.get()));
    EXPECT_FALSE(was_first());
  }
  EXPECT_FALSE(wait(kNow));
}

TEST_F(WaitSetTest, MessagesAndDescriptorsWakeAlike) {
  const auto name = fresh_name();
  const auto sink = sink_of(name);
  const auto source = source_of(name);
  const std::array<Source*, 1> sources = {source.get()};
  const std::array descriptors = {first_.descriptor()};
  Message message;
  for (int i = 0; i < 100; ++i) {
    ASSERT_EQ(must(source->take(message)), Got::Nothing);
    if (i % 3 == 0) {
      first_.raise();
    } else {
      ASSERT_TRUE(sink->send(numbered(i, kSmall)));
    }
    ASSERT_TRUE(must(waits_.wait(sources, descriptors, kLong)));
    EXPECT_EQ(was_first(), i % 3 == 0);
    EXPECT_EQ(must(source->take(message)), i % 3 == 0 ? Got::Nothing : Got::Message);
    if (i % 3 == 0) first_.clear();
  }
}

TEST_F(WaitSetTest, ItsStopEndsAWait) {
  const Event stop = must(Event::make());
  WaitSet waits(stop.descriptor());
  stop.raise();
  first_.raise();
  EXPECT_EQ(refused(waits.wait({}, std::array{first_.descriptor()}, kLong)).code, Code::Stopped);
}

}  // namespace
}  // namespace hc::testing
