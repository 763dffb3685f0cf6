// SPDX-License-Identifier: Apache-2.0
// Where there is no room for all messages: who loses which, who waits, and what is held.
#include <hc/link/shm/shm_test.h>

#include <thread>
#include <vector>

namespace hc::testing {
namespace {

class ShmRoom : public ShmLink {};

/// Takes what is there, and gives how many messages it was.
int drain(Source& source, Message& message) {
  int count = 0;
  while (*source.take(message) == Got::Message) ++count;
  return count;
}

TEST_F(ShmRoom, ASlotIsUsedAgainOnlyWhenNobodyHoldsIt) {
  open("?memory=2M");
  ASSERT_TRUE(sink_->send(numbered(1, kLarge)));
  const Message held = next(*source_);
  for (int i = 2; i < 200; ++i) {
    ASSERT_TRUE(sink_->send(numbered(i, kLarge)));
    const Message message = next(*source_);
    EXPECT_NE(message.elements.data(), held.elements.data());
    EXPECT_EQ(message.text(), numbered(i, kLarge).text());
  }
  EXPECT_EQ(held.text(), numbered(1, kLarge).text());
  source_.reset();
  EXPECT_EQ(held.text(), numbered(1, kLarge).text());
}

TEST_F(ShmRoom, WhoKeepsTheLatestGetsItAndLosesTheOthers) {
  for (auto size : {kSmall, kLarge}) {
    open("?memory=2M", "?keep=latest");
    constexpr int kCount = 5000;  // more than there are cells, more than fit into the memory
    for (int i = 0; i < kCount; ++i) ASSERT_TRUE(sink_->send(numbered(i, size)));
    Message message;
    ASSERT_EQ(drain(*source_, message), 1);
    ASSERT_TRUE(sink_->send(numbered(kCount, size)));
    EXPECT_EQ(next(*source_).text(), numbered(kCount, size).text());
    EXPECT_EQ(source_->traffic().dropped_newer, static_cast<std::uint64_t>(kCount) - 1);
    EXPECT_EQ(source_->traffic().messages, 2U);
  }
}

TEST_F(ShmRoom, WhoKeepsMoreThanFitsLosesTheOldest) {
  open("?memory=2M&keep=30");
  for (int i = 0; i < 100; ++i) ASSERT_TRUE(sink_->send(numbered(i, kLarge)));
  std::vector<std::int64_t> seen;
  Message message;
  while (*source_->take(message) == Got::Message) seen.push_back(message.header.seq);
  ASSERT_FALSE(seen.empty());
  EXPECT_EQ(seen.back(), 99);
  for (std::size_t i = 1; i < seen.size(); ++i) EXPECT_EQ(seen[i], seen[i - 1] + 1);
  EXPECT_EQ(source_->traffic().dropped_newer, 70U);
  EXPECT_EQ(seen.size() + source_->traffic().dropped_memory, 30U);
  EXPECT_GT(source_->traffic().dropped_memory, 0U);  // fewer fit
}

TEST_F(ShmRoom, ASlowReaderOfTheLatestHoldsUpNobody) {
  auto name = fresh_name();
  auto sink = sink_of(name + "?readers=2&memory=2M");
  auto slow = source_of(name + "?keep=latest");
  auto quick = source_of(name);
  constexpr int kCount = 5000;
  for (int i = 0; i < kCount; ++i) {
    ASSERT_TRUE(sink->send(numbered(i, i % 2 == 0 ? kSmall : kLarge)));
    ASSERT_EQ(next(*quick).header.seq, i);
  }
  Message message;
  EXPECT_EQ(drain(*slow, message), 1);
  EXPECT_EQ(message.header.seq, kCount - 1);
  EXPECT_EQ(slow->traffic().dropped_newer, kCount - 1U);
}

TEST_F(ShmRoom, AReaderThatHoldsTooManyGetsCopiesWhichIsLogged) {
  auto name = fresh_name();
  auto sink = sink_of(name);
  int told = 0;
  LinkOptions options;
  options.log = [&](Level, std::string_view line) {
    EXPECT_NE(line.find("are held"), std::string_view::npos) << line;
    ++told;
  };
  auto source = source_of(name, options);
  std::vector<Message> held;
  for (int i = 0; i < 100; ++i) {
    ASSERT_TRUE(sink->send(numbered(i, kLarge)));
    held.push_back(next(*source));
  }
  EXPECT_EQ(told, 1);
  for (int i = 0; i < 100; ++i)
    EXPECT_EQ(held[static_cast<std::size_t>(i)].text(), numbered(i, kLarge).text());
}

TEST_F(ShmRoom, AReaderThatHoldsAllDoesNotStallAPublisherThatDrops) {
  open("?keep=latest&memory=2M");
  std::vector<Message> held(100);
  int count = 0;
  for (int i = 0; i < 100; ++i) {
    ASSERT_TRUE(sink_->send(numbered(i, kLarge)));
    if (*source_->take(held[static_cast<std::size_t>(i)]) == Got::Message) ++count;
  }
  EXPECT_LT(count, 100);
  EXPECT_EQ(sink_->traffic().messages, 100U);
  EXPECT_EQ(sink_->traffic().dropped_memory + static_cast<std::uint64_t>(count), 100U);
}

TEST_F(ShmRoom, APublisherWaitsForRoomUntilItIsLetGo) {
  open("?memory=2M");
  std::vector<Message> held;
  auto publisher = send_all(*sink_, 100, kLarge);
  for (int i = 0; i < 100; ++i) {
    held.push_back(next(*source_));
    ASSERT_EQ(held.back().header.seq, i);
    if (held.size() == 7) held.clear();
  }
  publisher.join();
}

TEST_F(ShmRoom, AProgramThatKeepsAllLoansGetsAnError) {
  open("?memory=2M");
  std::vector<Draft> loans;
  for (int i = 0; i < 30; ++i) loans.push_back(sink_->loan(numbered(i, kLarge).header));
  EXPECT_EQ(refused(sink_->send(numbered(0, kLarge))).text(),
            "TooLarge: no room left: this program holds all of the memory");
}

}  // namespace
}  // namespace hc::testing
