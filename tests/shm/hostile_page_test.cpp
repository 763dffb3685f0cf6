// SPDX-License-Identifier: Apache-2.0
// Readers of shared memory whose page says what cannot be: the publisher continues, and its other
// readers get what they should.
#include <atomic>

#include "checked_message.h"
#include "hostile_peer.h"

namespace hc::testing {
namespace {

using internal::kSlotsBegin;

/// A reader whose page is the test's own to write.
class FakeReader {
 public:
  FakeReader(const std::string& name, std::uint64_t keep)
      : socket_(connect_to_publisher(name)),
        page_(std::move(*SharedMemory::make(kPageBytes, 0))),
        offer_(greet(keep)) {}

  [[nodiscard]] internal::ReaderPage& page() const {
    return *reinterpret_cast<internal::ReaderPage*>(page_.data());
  }
  [[nodiscard]] const internal::Head& head() const {
    return *reinterpret_cast<const internal::Head*>(offer_.memory.data());
  }
  [[nodiscard]] std::uint64_t keep() const { return offer_.keep; }

 private:
  internal::Offer greet(std::uint64_t keep) const {
    EXPECT_TRUE(internal::send_hello(socket_.get(), keep, page_, pipe_.get()));
    return std::move(*internal::await_offer(socket_.get(), -1));
  }

  Descriptor socket_;
  SharedMemory page_;
  Descriptor pipe_ = make_pipe();
  internal::Offer offer_;
};

/// Writes nonsense near what the publisher counts with.
void disturb(const FakeReader& reader, const std::atomic<bool>& done) {
  Dice dice;
  auto& words = reader.page();
  while (!done.load(std::memory_order_relaxed)) {
    auto number = dice();
    switch (number % 8) {
      case 0:
        words.cursor.store(number, std::memory_order_relaxed);
        break;
      case 1:
      case 2:
        words.cursor.store(reader.head().published.load() + 8 - number / 8 % 2048,
                           std::memory_order_relaxed);
        break;
      case 3:
        words.cursor.store(internal::ReaderPage::kLeft, std::memory_order_relaxed);
        break;
      case 4:
        words.armed.store(static_cast<std::uint32_t>(number >> 8), std::memory_order_relaxed);
        break;
      case 5:
        words.progress.fetch_add(1, std::memory_order_relaxed);
        futex_wake(words.progress);  // else the publisher would mostly sleep
        break;
      default:
        words.held[number / 8 % internal::kMostHeld].store(
            number % 32 == 7 ? kSlotsBegin + number / 1024 % 64 * 100'032 : 0,
            std::memory_order_relaxed);
    }
  }
  for (auto& held : words.held) held.store(0);
  words.cursor.store(internal::ReaderPage::kLeft);
}

/// Takes so many messages, of which every one comes whole.
void take_all(Source& source, std::int64_t count) {
  Message message;
  for (std::int64_t i = 0; i < count; ++i) {
    auto got = receive(source, message);
    ASSERT_TRUE(got) << got.error().text();
    ASSERT_TRUE(*got);
    ASSERT_EQ(message.header.seq, i);
    ASSERT_TRUE(is_whole(message));
  }
}

/// The other reader gets every message, whole.
TEST(HostileReaderPage, WordsChangeWhileTheyAreUsed) {
  for (std::uint64_t keep : {0U, 1U, 700U}) {
    auto name = fresh_name();
    auto sink = std::move(*open_sink(*parse_uri(name + "?memory=2M")));
    auto source = std::move(*open_source(*parse_uri(name)));
    FakeReader hostile(name, keep);
    std::atomic<bool> done{false};
    std::thread writer([&] { disturb(hostile, done); });
    const auto count = rounds(30'000) / 3;
    std::thread publisher([&] {
      constexpr std::array<std::int32_t, 6> kSizes = {0, 24, 300, 4096, 24, 100'000};
      for (std::int64_t i = 0; i < count; ++i) {
        auto message = make_checked(i % 2 == 0 ? sink.get() : nullptr, 1, i,
                                    kSizes[static_cast<std::size_t>(i) % kSizes.size()]);
        auto sent = sink->send(message);
        ASSERT_TRUE(sent) << sent.error().text();
      }
      ASSERT_TRUE(sink->close());
    });
    take_all(*source, count);
    publisher.join();
    done = true;
    writer.join();
  }
}

/// Where it says that it is goes back and forth between two looks of the publisher.
TEST(HostileReaderPage, TheCursorGoesBackwards) {
  auto name = fresh_name();
  auto sink = std::move(*open_sink(*parse_uri(name)));
  auto source = std::move(*open_source(*parse_uri(name)));
  FakeReader hostile(name, 0);
  std::atomic<bool> done{false};
  std::thread writer([&] {
    Dice dice;
    while (!done.load(std::memory_order_relaxed)) {
      const auto& position = dice() % 2 == 0 ? hostile.head().published : hostile.head().oldest;
      for (auto i = dice() % 16; i > 0; --i)
        hostile.page().cursor.store(position.load(), std::memory_order_relaxed);
      if (dice() % 64 != 0) continue;
      hostile.page().progress.fetch_add(1);
      futex_wake(hostile.page().progress);
    }
    hostile.page().cursor.store(internal::ReaderPage::kLeft);
  });
  const auto count = rounds(300'000);
  std::thread publisher([&] {
    for (std::int64_t i = 0; i < count; ++i) {
      auto sent = sink->send(make_checked(nullptr, 1, i, 24));
      ASSERT_TRUE(sent) << sent.error().text();
    }
    ASSERT_TRUE(sink->close());
  });
  take_all(*source, count);
  publisher.join();
  done = true;
  writer.join();
}

/// Whatever it asks for, and however it continues.
TEST(HostileReaderPage, ItDoesNotStallAPublisherThatDrops) {
  for (std::uint64_t keep : {std::uint64_t{0}, std::uint64_t{1}, ~std::uint64_t{0} - 1}) {
    auto name = fresh_name();
    auto sink = std::move(*open_sink(*parse_uri(name + "?keep=latest&memory=2M&readers=2")));
    auto source = std::move(*open_source(*parse_uri(name)));
    FakeReader hostile(name, keep);
    EXPECT_GT(hostile.keep(), 0U);
    Message message;
    for (std::int64_t i = 0; i < 10'000; ++i) {
      auto& page = hostile.page();
      page.cursor.store(static_cast<std::uint64_t>(i < 5000 ? 5000 - i : 0));
      if (i % 5 == 0)  // a slot of those that there are, for good
        page.held[static_cast<std::size_t>(i / 5) % internal::kMostHeld].store(
            kSlotsBegin + static_cast<std::uint64_t>(i) / 5 % 5 * 100'032);
      ASSERT_TRUE(sink->send(make_checked(nullptr, 1, i, i % 2 == 0 ? 24 : 100'000)));
      ASSERT_TRUE(*receive(*source, message));
      EXPECT_EQ(message.header.seq, i);
      EXPECT_TRUE(is_whole(message));
    }
  }
}

}  // namespace
}  // namespace hc::testing
