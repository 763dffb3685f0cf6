// SPDX-License-Identifier: Apache-2.0
#pragma once
// What every transport must do, written once; each transport's test says how its ends are opened.
// No sleeps: everything waits for the other side, and the test runner's time-out is the watchdog.

#include <gtest/gtest.h>

#include <atomic>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <hc/link/link.h>
#include <hc/os/event.h>

namespace hc::testing {

/// A transport under test.
struct Transport {
  std::string name;
  /// URIs of a fresh link: where messages come out, and where they go in.
  std::function<std::pair<std::string, std::string>()> make;
  bool sink_first = false;  ///< which end must be opened first
  bool ends = true;         ///< the source ends when the sink closes (one that listens does not)
  /// What a slow reader loses it skips and counts itself, when it comes to it; it keeps the rate.
  bool drops_at_source = false;
};

inline void PrintTo(const Transport& transport, std::ostream* out) {
  *out << transport.name;
}

inline std::unique_ptr<Source> source_of(const std::string& uri, LinkOptions options = {}) {
  auto source = open_source(*parse_uri(uri), options);
  EXPECT_TRUE(source) << uri << ": " << source.error().text();
  return std::move(*source);
}
inline std::unique_ptr<Sink> sink_of(const std::string& uri, LinkOptions options = {}) {
  auto sink = open_sink(*parse_uri(uri), options);
  EXPECT_TRUE(sink) << uri << ": " << sink.error().text();
  return std::move(*sink);
}

/// A URI with one more option, or several.
inline std::string with(const std::string& uri, const std::string& options) {
  return uri + (uri.find('?') == std::string::npos ? "?" : "&") + options;
}

/// What asks links to stop, once raised and for ever.
class Stop {
 public:
  void raise() const { event_.raise(); }
  [[nodiscard]] LinkOptions options() const {
    LinkOptions options;
    options.stop = event_.descriptor();
    return options;
  }

 private:
  internal::Event event_ = internal::Event::must_make();
};

/// A message with `size` bytes of elements that its seq determines.
inline Message numbered(std::int64_t seq, std::int32_t size) {
  Header header;
  header.info = {MatrixType::IntensityImage, 1, Scalar::U8, Encoding::Binary};
  header.width = size;
  header.height = 1;
  header.seq = seq;
  Draft draft = Draft::make(header);
  for (auto& byte : draft.elements()) byte = static_cast<std::byte>(seq * 7 + size);
  return std::move(draft).finish();
}

// Tests that use the helpers above alone need not run the suite.
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(LinkConformance);

class LinkConformance : public ::testing::TestWithParam<Transport> {
 protected:
  /// @param options  of the sink. @param pace  of the end that keeps it.
  void open(const std::string& options = "", const std::string& pace = "",
            const LinkOptions& of_sink = {}) {
    auto [from, to] = GetParam().make();
    if (!options.empty()) to = with(to, options);
    auto& paced = GetParam().drops_at_source ? from : to;
    if (!pace.empty()) paced = with(paced, pace);
    if (GetParam().sink_first) sink_ = sink_of(to, of_sink);
    source_ = source_of(from);
    if (!GetParam().sink_first) sink_ = sink_of(to, of_sink);
  }

  /// Sends from another thread, takes here, compares.
  void transfer(int count, std::int32_t size) {
    std::thread sender([&] {
      for (int i = 0; i < count; ++i) ASSERT_TRUE(sink_->send(numbered(i, size)));
      ASSERT_TRUE(sink_->close());
    });
    Message message;
    for (int i = 0; i < count; ++i) {
      auto got = receive(*source_, message);
      ASSERT_TRUE(got && *got) << i;
      Message wanted = numbered(i, size);
      ASSERT_EQ(message.header, wanted.header);
      ASSERT_EQ(message.characters(), wanted.characters());
    }
    sender.join();
    EXPECT_EQ(source_->traffic().messages, static_cast<std::uint64_t>(count));
    EXPECT_EQ(sink_->traffic().messages, static_cast<std::uint64_t>(count));
    if (!GetParam().ends) return;
    auto end = receive(*source_, message);
    ASSERT_TRUE(end) << end.error().text();
    EXPECT_FALSE(*end);
  }

  /// What both ends have lost; of no other use.
  [[nodiscard]] Traffic losses() const {
    Traffic both = sink_->traffic();
    both += source_->traffic();
    return both;
  }

  /// Sends, while nobody reads, until some have been lost for sure; gives how many it sent.
  std::int64_t send_too_many(std::int32_t size) {
    constexpr std::int64_t kPlenty = 500;  // more than are kept, or fit into the memory
    std::int64_t count = 0;
    while (GetParam().drops_at_source ? count < kPlenty : losses().lost() < 10)
      EXPECT_TRUE(sink_->send(numbered(count++, size)));
    return count;
  }

  /// Closes the sink, takes what there is up to message `last`, and checks that it comes in order,
  /// and that what does not come was counted. Gives how many came.
  std::uint64_t take_to(std::int64_t last) {
    std::thread closer([&] { ASSERT_TRUE(sink_->close()); });
    Message message;
    std::uint64_t received = 0;
    for (std::int64_t seq = -1; seq < last; ++received) {
      auto got = receive(*source_, message);
      if (!got || !*got || message.header.seq <= seq) {
        ADD_FAILURE() << "behind " << seq;
        break;
      }
      seq = message.header.seq;
      EXPECT_EQ(message.characters(),
                numbered(seq, static_cast<std::int32_t>(message.elements.size())).characters());
    }
    closer.join();
    EXPECT_EQ(sink_->traffic().messages, static_cast<std::uint64_t>(last) + 1);
    EXPECT_EQ(sink_->traffic().messages, received + losses().lost());
    return received;
  }

  std::unique_ptr<Source> source_;
  std::unique_ptr<Sink> sink_;
};

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
  std::thread sender([&] {
    for (int i = 0; i < 500; ++i) ASSERT_TRUE(sink_->send(numbered(i, 100'000)));
    ASSERT_TRUE(sink_->close());
  });
  Message message;
  for (int i = 0; i < 500; ++i) {
    // One look at the descriptor between any two messages, so that the sender runs ahead.
    auto got = receive(*source_, message);
    ASSERT_TRUE(got && *got);
    ASSERT_EQ(message.header.seq, i);
    std::this_thread::yield();
  }
  sender.join();
}

TEST_P(LinkConformance, AReaderThatTakesNothingIsGivenUpUntilItDoes) {
  constexpr std::int64_t kPlenty = 1200;  // more than any memory takes
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
      ASSERT_EQ(message.characters(), numbered(seq, 100'000).characters());
    }
    is_heard_again = true;
    while (message.elements.size() > 1) ASSERT_TRUE(*receive(*source_, message));
  });
  while (!is_heard_again) ASSERT_TRUE(sink_->send(numbered(count++, 100'000)));
  ASSERT_TRUE(sink_->send(numbered(count, 1)));
  reader.join();
  EXPECT_GT(losses().timed_out, 0U);
  EXPECT_EQ(losses().timed_out, losses().lost());
}

TEST_P(LinkConformance, AMessageMayBeHeldForAsLongAsOneLikes) {
  open();
  std::thread sender([&] {
    for (int i = 0; i < 100; ++i) ASSERT_TRUE(sink_->send(numbered(i, 1 + i * 500)));
    ASSERT_TRUE(sink_->close());
  });
  std::vector<Message> held(100);
  for (auto& message : held) ASSERT_TRUE(*receive(*source_, message));
  sender.join();
  for (int i = 0; i < 100; ++i)
    EXPECT_EQ(held[static_cast<std::size_t>(i)].characters(),
              numbered(i, 1 + i * 500).characters());
}

TEST_P(LinkConformance, AReaderThatLeavesIsNoticed) {
  open();
  std::thread reader([&] {
    Message message;
    ASSERT_TRUE(*receive(*source_, message));
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
  std::thread sender([&] {
    for (int i = 0; i < kCount; ++i)
      ASSERT_TRUE(sink_->send(numbered(i, i % 100 == 99 ? 200'000 : i % 50)));
    ASSERT_TRUE(sink_->close());
  });
  Message message;
  for (int i = 0; i < kCount; ++i) {
    ASSERT_TRUE(*receive(*source_, message));
    ASSERT_EQ(message.characters(), numbered(i, i % 100 == 99 ? 200'000 : i % 50).characters());
  }
  sender.join();
}

TEST_P(LinkConformance, WithKeepLatestTheWriterNeverWaits) {
  open("keep=latest");
  auto count = send_too_many(100'000);  // nobody reads, and this ends all the same
  take_to(count - 1);
  EXPECT_GE(losses().superseded, 10U);
  EXPECT_EQ(losses().superseded, losses().lost());
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
  EXPECT_GE(received, 5U);  // and what the kernel had taken
  if (GetParam().drops_at_source)
    EXPECT_EQ(received, 5U);
  else
    EXPECT_EQ(losses().lost(), lost_until_now);
}

TEST_P(LinkConformance, MemoryIsBounded) {
  open("keep=1000&memory=2M");
  auto count = send_too_many(100'000);
  take_to(count - 1);
  EXPECT_GE(losses().over_memory, 10U);
  EXPECT_EQ(losses().superseded, 0U);
}

TEST_P(LinkConformance, ARateKeepsMessagesBack) {
  open("keep=2", "rate=20&burst=3");
  for (int i = 0; i < 10; ++i) ASSERT_TRUE(sink_->send(numbered(i, 10)));
  take_to(9);
  EXPECT_GE(losses().kept_back, losses().over_rate);
  EXPECT_EQ(losses().over_memory + losses().cut, 0U);
}

TEST_P(LinkConformance, AWriterThatLosesNothingWaitsForItsTurn) {
  open("", "rate=1000");
  transfer(20, 10);
  EXPECT_EQ(sink_->traffic().lost(), 0U);
}

TEST_P(LinkConformance, AReaderThatLeavesIsNoticedByAWriterThatDoesNotWait) {
  open("keep=latest");
  ASSERT_TRUE(sink_->send(numbered(0, 10)));
  Message message;
  ASSERT_TRUE(*receive(*source_, message));
  source_.reset();
  Status sent;
  for (int i = 0; sent; ++i) sent = sink_->send(numbered(i, 100'000));
  EXPECT_EQ(sent.error().code, Code::Closed);
}

TEST_P(LinkConformance, OptionsOfAnotherTransportAreRefused) {
  auto [from, to] = GetParam().make();
  auto source = open_source(*parse_uri(with(from, "flavour=sweet")));
  ASSERT_FALSE(source);
  EXPECT_EQ(source.error().code, Code::Invalid);
}

}  // namespace hc::testing
