// SPDX-License-Identifier: Apache-2.0
#include <hc/testing/link_conformance.h>

namespace hc::testing {

TEST_P(LinkConformance, CarriesOneMessageAndEnds) {
  open();
  transfer(1, 3);
}
TEST_P(LinkConformance, CarriesManySmallOnes) {
  open();
  transfer(20000, 24);
}
TEST_P(LinkConformance, CarriesHugeOnes) {
  open();
  transfer(3, 40'000'000);
}
TEST_P(LinkConformance, CarriesEmptyOnes) {
  open();
  transfer(10, 0);
}

TEST_P(LinkConformance, EndsWithoutAMessageOrWaitsForTheNextWriter) {
  open();
  std::thread sender([&] { ASSERT_TRUE(sink_->close()); });
  Message message;
  if (GetParam().ends) {
    EXPECT_FALSE(*receive(*source_, message));
    EXPECT_FALSE(*receive(*source_, message));
  } else {
    EXPECT_EQ(*source_->take(message), Got::Nothing);
  }
  sender.join();
}

TEST_P(LinkConformance, NothingIsNoEnd) {
  open();
  Message message;
  EXPECT_EQ(*source_->take(message), Got::Nothing);
  transfer(1, 1);
}

TEST_P(LinkConformance, ASlowReaderLosesNothing) {
  open();
  auto sender = send_all(*sink_, 500, 100'000);
  for (int i = 0; i < 500; ++i) {
    // Checks the descriptor between any two messages, so that the sender gets ahead.
    ASSERT_EQ(next(*source_).header.seq, i);
    std::this_thread::yield();
  }
  sender.join();
}

TEST_P(LinkConformance, AReaderThatTakesNothingIsGivenUpUntilItDoes) {
  constexpr std::int64_t kPlenty = 1200;  // exceeds all buffers
  LinkOptions options;
  std::vector<bool> awaits;
  options.awaits_reader = [&](bool does) { awaits.push_back(does); };
  open("timeout=1", "", options);
  std::int64_t count = 0;
  while (count < kPlenty) ASSERT_TRUE(sink_->send(numbered(count++, 100'000)));
  ASSERT_GE(awaits.size(), 2U) << "it waited for it";
  EXPECT_FALSE(awaits.back()) << "and does not any more";
  std::atomic<bool> is_heard_again{false};
  std::thread reader([&] {
    Message message;
    std::int64_t seq = -1;
    while (seq < kPlenty) {
      auto got = receive(*source_, message);
      ASSERT_TRUE(got && *got && message.header.seq > seq) << "behind " << seq;
      seq = message.header.seq;
      ASSERT_EQ(message.text(), numbered(seq, 100'000).text());
    }
    is_heard_again = true;
    while (message.elements.size() > 1) ASSERT_TRUE(*receive(*source_, message));
  });
  while (!is_heard_again) ASSERT_TRUE(sink_->send(numbered(count++, 100'000)));
  ASSERT_TRUE(sink_->send(numbered(count, 1)));
  reader.join();
  EXPECT_GT(losses().dropped_timeout, 0U);
  EXPECT_EQ(losses().dropped_timeout, losses().lost());
}

TEST_P(LinkConformance, AMessageMayBeHeldForAsLongAsOneLikes) {
  open();
  const auto size = [](int i) { return 1 + i * 500; };
  auto sender = send_all(*sink_, 100, size);
  std::vector<Message> held;
  for (int i = 0; i < 100; ++i) held.push_back(next(*source_));
  sender.join();
  for (int i = 0; i < 100; ++i)
    EXPECT_EQ(held[static_cast<std::size_t>(i)].text(), numbered(i, size(i)).text());
}

TEST_P(LinkConformance, AReaderThatLeavesIsNoticed) {
  open();
  std::thread reader([&] {
    next(*source_);
    source_.reset();
  });
  Status sent;
  for (int i = 0; sent; ++i) sent = sink_->send(numbered(i, 100'000));
  reader.join();
  EXPECT_EQ(sent.error().code, Code::Closed);
}

TEST_P(LinkConformance, SmallAndLargeOnesStayInOrder) {
  open();
  constexpr int kCount = 2000;
  const auto size = [](int i) { return i % 100 == 99 ? 200'000 : i % 50; };
  auto sender = send_all(*sink_, kCount, size);
  for (int i = 0; i < kCount; ++i) ASSERT_EQ(next(*source_).text(), numbered(i, size(i)).text());
  sender.join();
}

TEST_P(LinkConformance, WithKeepLatestTheWriterNeverWaits) {
  open("keep=latest");
  auto count = send_too_many(100'000);  // also ends without a reader
  take_to(count - 1);
  EXPECT_GE(losses().dropped_newer, 10U);
  EXPECT_EQ(losses().dropped_newer, losses().lost());
}

TEST_P(LinkConformance, WithKeepLatestSmallOnesAreWholeToo) {
  open("keep=latest");
  auto count = send_too_many(30);
  take_to(count - 1);
}

TEST_P(LinkConformance, KeepsAsManyAsAsked) {
  open("keep=5");
  auto count = send_too_many(100'000);
  auto lost_until_now = losses().lost();
  auto received = take_to(count - 1);
  EXPECT_GE(received, 5U);  // and those in the kernel's buffers
  if (GetParam().drops_at_source)
    EXPECT_EQ(received, 5U);
  else
    EXPECT_EQ(losses().lost(), lost_until_now);
}

TEST_P(LinkConformance, MemoryIsBounded) {
  open("keep=1000&memory=2M");
  auto count = send_too_many(100'000);
  take_to(count - 1);
  EXPECT_GE(losses().dropped_memory, 10U);
  EXPECT_EQ(losses().dropped_newer, 0U);
}

TEST_P(LinkConformance, ARateKeepsMessagesBack) {
  open("keep=2", "rate=20&burst=3");
  for (int i = 0; i < 10; ++i) ASSERT_TRUE(sink_->send(numbered(i, 10)));
  take_to(9);
  EXPECT_GE(losses().delayed, losses().throttled);
  EXPECT_EQ(losses().dropped_memory + losses().dropped_disconnect, 0U);
}

TEST_P(LinkConformance, ABandwidthKeepsBytesBack) {
  open("", "bandwidth=1MB/s");
  const auto begin = std::chrono::steady_clock::now();
  transfer(20, 10'000);
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
  // All but the first and a burst wait for the bytes before them.
  EXPECT_GE(taken.count(), (20 * 10'000 - 10'000 - 25'000) / 1e6);
  EXPECT_GT(losses().delayed, 0U);
  EXPECT_EQ(losses().lost(), 0U);
}

TEST_P(LinkConformance, AWriterThatLosesNothingWaitsForItsTurn) {
  open("", "rate=1000");
  transfer(20, 10);
  EXPECT_EQ(sink_->traffic().lost(), 0U);
}

TEST_P(LinkConformance, AReaderThatLeavesIsNoticedByAWriterThatDoesNotWait) {
  open("keep=latest");
  ASSERT_TRUE(sink_->send(numbered(0, 10)));
  next(*source_);
  source_.reset();
  Status sent;
  for (int i = 0; sent; ++i) sent = sink_->send(numbered(i, 100'000));
  EXPECT_EQ(sent.error().code, Code::Closed);
}

TEST_P(LinkConformance, OptionsOfAnotherTransportAreRefused) {
  auto [from, to] = GetParam().make();
  EXPECT_EQ(refused(open_source(*parse_uri(with(from, "flavour=sweet")))).code, Code::Invalid);
}

}  // namespace hc::testing
