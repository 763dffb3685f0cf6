// SPDX-License-Identifier: Apache-2.0
#include <hc/link/stream/writer.h>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <random>
#include <string>

namespace hc::testing {
namespace {

using internal::Parcel;
using internal::StreamWriter;

Pieces pieces_of(std::string_view text) {
  auto bytes = std::as_bytes(std::span(text));
  auto head = std::min<std::size_t>(bytes.size(), 3), end = std::min(bytes.size(), head + 1);
  return {bytes.first(head), bytes.subspan(head, bytes.size() - end), bytes.last(end - head)};
}

/// Text in which no part looks like another.
std::string text_of(std::size_t size, unsigned seed) {
  std::minstd_rand random(seed);
  std::string text(size, '\0');
  for (auto& c : text) c = static_cast<char>(random() >> 8);
  return text;
}

/// A pair of connected sockets, where few bytes are in flight.
struct Connection {
  Descriptor writing, reading;

  Connection() {
    std::array<int, 2> pair{};
    EXPECT_EQ(::socketpair(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK, 0, pair.data()), 0);
    writing = Descriptor(pair[0]);
    reading = Descriptor(pair[1]);
    constexpr int kBytes = 4096;
    ::setsockopt(writing.get(), SOL_SOCKET, SO_SNDBUF, &kBytes, sizeof kBytes);
  }
  /// Reads so much, or all that there is now.
  [[nodiscard]] std::string read(std::size_t most = std::string::npos) const {
    std::string text;
    std::array<char, 1000> bytes;
    while (text.size() < most) {
      auto size = ::read(reading.get(), bytes.data(), std::min(bytes.size(), most - text.size()));
      if (size <= 0) break;
      text.append(bytes.data(), static_cast<std::size_t>(size));
    }
    return text;
  }
};

class StreamWriterTest : public ::testing::Test {
 protected:
  StreamWriterTest() { writer_.start({std::move(connection_.writing)}); }

  void add_small(const std::string& text) {
    EXPECT_TRUE(writer_.add({pieces_of(text), nullptr}));
    EXPECT_FALSE(writer_.borrows());
  }
  void add_large(const std::string& text) { EXPECT_FALSE(writer_.add({pieces_of(text), keeper_})); }
  /// Goes over to another connection; what had come over the last one is forgotten.
  void reconnect() {
    connection_ = Connection();
    writer_.start({std::move(connection_.writing)});
  }
  /// Writes and reads in turn until all has been written.
  std::string transfer() {
    std::string text;
    while (true) {
      auto written = writer_.write();
      EXPECT_TRUE(written) << written.error().text();
      text += connection_.read();
      if (!written || *written) return text;
    }
  }

  Connection connection_;
  StreamWriter writer_;
  std::shared_ptr<const void> keeper_ = std::make_shared<int>();
  const std::string small_ = text_of(100, 1), other_ = text_of(5000, 2);
  const std::string large_ = text_of(300'000, 3);
};

TEST_F(StreamWriterTest, WhatIsGatheredGoesInOneCall) {
  EXPECT_TRUE(writer_.empty());
  const std::string few = text_of(50, 3);
  add_small(small_);
  add_small(few);
  EXPECT_EQ(writer_.gathered(), small_.size() + few.size());
  EXPECT_EQ(writer_.messages(), 2U);
  EXPECT_EQ(connection_.read(), "");
  EXPECT_TRUE(*writer_.write());
  EXPECT_TRUE(writer_.empty());
  EXPECT_EQ(writer_.messages(), 0U);
  EXPECT_EQ(connection_.read(), small_ + few);
}

TEST_F(StreamWriterTest, GathersAsMuchAsItSays) {
  EXPECT_FALSE(writer_.has_room(Parcel::kMostCopied + 1));
  const std::string text = text_of(Parcel::kMostCopied, 1);
  std::string all;
  for (; writer_.has_room(text.size()); all += text) add_small(text);
  EXPECT_EQ(all.size(), StreamWriter::kMostGathered);
  EXPECT_FALSE(writer_.has_room(1));
  EXPECT_EQ(transfer(), all);
}

TEST_F(StreamWriterTest, ALargeMessageGoesBehindWhatIsGathered) {
  add_small(small_);
  add_large(large_);
  EXPECT_FALSE(writer_.has_room(1));
  EXPECT_FALSE(*writer_.write());
  EXPECT_EQ(writer_.gathered(), 0U);
  EXPECT_FALSE(writer_.empty());
  EXPECT_TRUE(writer_.inside_message());
  EXPECT_FALSE(writer_.has_room(1));
  EXPECT_EQ(transfer(), small_ + large_);
  EXPECT_TRUE(writer_.has_room(1));
}

TEST_F(StreamWriterTest, KeepsALargeMessageAliveUntilItIsWritten) {
  std::weak_ptr<const void> alive = keeper_;
  add_large(large_);
  keeper_.reset();
  EXPECT_FALSE(writer_.borrows());
  EXPECT_FALSE(*writer_.write());
  EXPECT_FALSE(alive.expired());
  transfer();
  EXPECT_TRUE(alive.expired());
}

TEST_F(StreamWriterTest, ACopyMayStandForABorrowedMessageThatWasBegun) {
  {
    std::string borrowed = large_;
    EXPECT_FALSE(writer_.add({pieces_of(borrowed), nullptr}));
    EXPECT_TRUE(writer_.borrows());
    EXPECT_FALSE(*writer_.write());
    EXPECT_TRUE(writer_.borrows());
    writer_.keep({pieces_of(large_), keeper_});
    EXPECT_FALSE(writer_.borrows());
    borrowed.assign(borrowed.size(), 'x');
  }
  EXPECT_EQ(transfer(), large_);
}

/// Messages of any size, cut anywhere by a reader that takes any part.
TEST_F(StreamWriterTest, WritesInPartWhatThereIsRoomFor) {
  std::minstd_rand random(1);
  std::string sent, received, large;
  auto step = [&] {
    auto written = writer_.write();
    ASSERT_TRUE(written);
    EXPECT_EQ(*written, writer_.empty());
    received += connection_.read(random() % 4000);
  };
  for (unsigned i = 0; i < 3000; ++i) {
    auto text = text_of(random() % 10 == 0 ? 20'000 : random() % 3000, i + 1);
    bool is_large = text.size() > Parcel::kMostCopied;
    while (!writer_.has_room(is_large ? 0 : text.size())) step();
    sent += text;
    if (is_large)
      add_large(large = text);
    else
      add_small(text);
    if (random() % 2 == 0) step();
  }
  received += transfer();
  EXPECT_TRUE(received == sent);
}

TEST_F(StreamWriterTest, WhatIsWrittenWholeIsCountedNoMore) {
  const std::string text = text_of(8000, 1);
  for (int i = 0; i < 8; ++i) add_small(text);
  EXPECT_FALSE(*writer_.write());
  auto come = connection_.read();
  EXPECT_EQ(writer_.messages(), 8 - come.size() / text.size());
  EXPECT_EQ(writer_.gathered(), 8 * text.size() - come.size());
  EXPECT_EQ(writer_.inside_message(), come.size() % text.size() != 0);
}

TEST_F(StreamWriterTest, TakesBackWhatHasNotBegun) {
  EXPECT_FALSE(writer_.take_back());
  add_small(small_);
  add_small(other_);
  EXPECT_TRUE(writer_.take_back());
  EXPECT_EQ(writer_.messages(), 1U);
  add_large(large_);
  EXPECT_TRUE(writer_.take_back());
  EXPECT_FALSE(writer_.inside_message());
  add_small(other_);
  EXPECT_EQ(transfer(), small_ + other_);
}

TEST_F(StreamWriterTest, TakesNothingBackThatHasBegun) {
  add_large(large_);
  EXPECT_FALSE(*writer_.write());
  EXPECT_FALSE(writer_.take_back());
  EXPECT_EQ(transfer(), large_);

  std::string sent, received;
  while (!writer_.inside_message()) {
    if (writer_.empty()) {
      add_small(other_);
      sent += other_;
    }
    if (!*writer_.write()) received += connection_.read(100);
  }
  EXPECT_EQ(writer_.messages(), 1U);
  EXPECT_FALSE(writer_.take_back());
  add_small(small_);
  EXPECT_TRUE(writer_.take_back());
  EXPECT_EQ(received + transfer(), sent);
}

TEST_F(StreamWriterTest, ANewConnectionGetsTheMessageThatWasBegunWhole) {
  add_small(small_);
  add_large(large_);
  EXPECT_FALSE(*writer_.write());
  ASSERT_GT(connection_.read().size(), small_.size());
  reconnect();
  EXPECT_FALSE(writer_.inside_message());
  EXPECT_EQ(transfer(), large_);  // but not again what was written whole
}

TEST_F(StreamWriterTest, ANewConnectionGetsTheSmallOneThatWasBegunAndThoseBehindIt) {
  const std::string text = text_of(5000, 1);
  std::string all;
  for (int i = 0; i < 10; ++i) {
    add_small(text);
    all += text;
  }
  add_large(large_);
  EXPECT_FALSE(*writer_.write());
  auto whole = connection_.read().size() / text.size();
  ASSERT_LT(whole, 10U);
  for (int i = 0; i < 3; ++i) {  // also when it fails again and again
    reconnect();
    EXPECT_FALSE(*writer_.write());
    auto come = connection_.read();
    EXPECT_EQ(come, (all + large_).substr(whole * text.size(), come.size()));
    whole += come.size() / text.size();
    ASSERT_LT(whole, 10U);
  }
  reconnect();
  EXPECT_EQ(transfer(), (all + large_).substr(whole * text.size()));
}

TEST_F(StreamWriterTest, WithoutAConnectionItKeepsWhatThereIs) {
  add_small(small_);
  writer_.start({});
  EXPECT_EQ(writer_.descriptor(), -1);
  add_small(other_);
  reconnect();
  EXPECT_EQ(transfer(), small_ + other_);
}

TEST_F(StreamWriterTest, ForgetsAndCountsWhatIsNotWrittenWhole) {
  EXPECT_EQ(writer_.clear(), 0U);
  std::weak_ptr<const void> alive = keeper_;
  add_small(small_);
  add_small(other_);
  add_large(large_);
  keeper_.reset();
  EXPECT_EQ(writer_.clear(), 3U);
  EXPECT_TRUE(alive.expired());
  EXPECT_TRUE(writer_.empty());
  EXPECT_FALSE(writer_.inside_message());

  add_small(small_);
  add_large(large_);
  EXPECT_FALSE(*writer_.write());
  EXPECT_EQ(writer_.clear(), 1U);
}

TEST_F(StreamWriterTest, AReaderThatHasGoneIsAnError) {
  connection_.reading.reset();
  add_small(small_);
  auto written = writer_.write();
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().code, Code::Closed);
  EXPECT_EQ(writer_.messages(), 1U);  // for the next connection
  reconnect();
  EXPECT_EQ(transfer(), small_);
}

TEST_F(StreamWriterTest, APipeWithoutAReaderRaisesNoSignal) {
  std::array<int, 2> ends{};
  ASSERT_EQ(::pipe2(ends.data(), O_NONBLOCK | O_CLOEXEC), 0);
  Descriptor reading(ends[0]);
  writer_.start({Descriptor(ends[1])});
  add_small(small_);
  EXPECT_TRUE(*writer_.write());
  reading.reset();
  add_small(small_);
  EXPECT_EQ(writer_.write().error().code, Code::Closed);
  sigset_t pending;
  ::sigpending(&pending);
  EXPECT_EQ(::sigismember(&pending, SIGPIPE), 0);
}

TEST_F(StreamWriterTest, TheEndIsFoundBehindWhatWasWritten) {
  add_small(small_);
  EXPECT_TRUE(*writer_.write());
  writer_.close(std::chrono::seconds(0));
  EXPECT_EQ(writer_.descriptor(), -1);
  EXPECT_EQ(connection_.read(), small_);
  char byte = 0;
  EXPECT_EQ(::read(connection_.reading.get(), &byte, 1), 0);
}

}  // namespace
}  // namespace hc::testing
