// SPDX-License-Identifier: Apache-2.0
// Links that outlive the programs at their ends: `stay` of listening sinks, and finish() of
// reconnecting sources.
#include <unistd.h>

#include <atomic>
#include <thread>

#include <hc/testing/link_conformance.h>
#include <hc/testing/socket_link.h>

namespace hc::testing {
namespace {

/// The ends of a link whose sink listens.
struct Ends {
  std::string name, sink, source;
};

Ends ends_of(const std::string& scheme) {
  static int count = 0;
  auto word = "lasting-" + std::to_string(::getpid()) + "-" + std::to_string(count++);
  if (scheme == "tcp") {
    auto place = free_port();
    return {scheme, "tcp-listen:" + place, "tcp:" + place};
  }
  if (scheme == "unix") return {scheme, "unix-listen:@" + word, "unix:@" + word};
  return {scheme, "shm:" + word, "shm:" + word};
}

class LastingLink : public ::testing::TestWithParam<std::string> {
 protected:
  /// Opens both ends and transfers a message.
  void begin(const std::string& sink_options, const std::string& source_options = "") {
    sink_ = sink_of(ends_.sink + "?readers=1" + sink_options);
    source_ = source_of(ends_.source + source_options, warnings_.options());
    carry(*sink_, *source_, numbered(0, 10));
  }

  const Ends ends_ = ends_of(GetParam());
  Warnings warnings_;
  std::unique_ptr<Sink> sink_;
  std::unique_ptr<Source> source_;
  Message message_;
};

INSTANTIATE_TEST_SUITE_P(Schemes, LastingLink, ::testing::Values("tcp", "unix", "shm"),
                         [](const auto& test) { return test.param; });

TEST_P(LastingLink, WhoDropsGoesOnWithoutReadersAndCounts) {
  begin("&stay=1&keep=latest");
  source_.reset();
  while (sink_->traffic().dropped_disconnect == 0) ASSERT_TRUE(sink_->send(numbered(1, 10)));
  source_ = source_of(ends_.source);
  std::atomic<bool> heard = false;
  std::thread sender([&] {
    while (!heard) ASSERT_TRUE(sink_->send(numbered(2, 10)));
  });
  ASSERT_TRUE(*receive(*source_, message_));
  heard = true;
  sender.join();
  EXPECT_EQ(message_.header.seq, 2);
}

/// For sinks with a queue.
class QueuedLink : public LastingLink {};
INSTANTIATE_TEST_SUITE_P(Schemes, QueuedLink, ::testing::Values("tcp", "unix"),
                         [](const auto& test) { return test.param; });

TEST_P(QueuedLink, WhatWaitsWhenItIsAbandonedIsLost) {
  auto sink = sink_of(ends_.sink + "?keep=2&rate=1");
  auto source = source_of(ends_.source);
  Message message;
  ASSERT_TRUE(sink->send(numbered(0, 10)));
  const auto bytes_of_one = sink->traffic().bytes;
  EXPECT_GT(bytes_of_one, 0U);
  for (int i = 1; i < 4; ++i) ASSERT_TRUE(sink->send(numbered(i, 10)));
  EXPECT_EQ(next(*source).header.seq, 0);
  sink->abandon();
  const auto traffic = sink->traffic();
  EXPECT_EQ(traffic.messages, 4U);
  EXPECT_EQ(traffic.dropped_disconnect, 2U);
  EXPECT_EQ(traffic.throttled, 1U);
  EXPECT_EQ(traffic.bytes, bytes_of_one) << "what was never sent has no bytes";
  sink.reset();
  EXPECT_FALSE(*receive(*source, message));
}

/// Sends messages with this `seq` until a reader that connects meanwhile has received one; returns
/// the first `seq` it received.
/// @param source  becomes the reader, and stays connected.
std::int64_t first_of_next_reader(Sink& sink, const std::string& uri, std::int64_t seq,
                                  std::unique_ptr<Source>& source) {
  std::atomic<bool> heard = false, done = false;
  std::thread sender([&] {
    while (!heard && sink.send(numbered(seq, 10))) continue;
    done = true;
  });
  source = source_of(uri);
  Message message;
  EXPECT_TRUE(*receive(*source, message));
  const auto first = message.header.seq;
  heard = true;
  while (!done && source->take(message)) continue;
  sender.join();
  return first;
}

TEST_P(LastingLink, WhoLosesNothingWaitsForTheNextReader) {
  begin("&stay=1");
  source_.reset();
  // A message sent before the loss of the reader is detected reaches no reader.
  EXPECT_EQ(first_of_next_reader(*sink_, ends_.source, 1, source_), 1);
  EXPECT_LE(sink_->traffic().dropped_disconnect, 1U);  // in transit to the reader that left
}

TEST_P(LastingLink, WhoHasLeftIsGivenUpUntilAnotherComes) {
  for (const char* options : {"?readers=1&stay=1&timeout=1", "?timeout=1"}) {
    SCOPED_TRACE(options);
    const Ends ends = ends_of(GetParam());
    const auto sink = sink_of(ends.sink + options);
    auto source = source_of(ends.source);
    carry(*sink, *source, numbered(0, 10));
    source.reset();
    while (sink->traffic().dropped_timeout < 3) ASSERT_TRUE(sink->send(numbered(1, 10)));
    EXPECT_EQ(first_of_next_reader(*sink, ends.source, 2, source), 2);
  }
}

TEST_P(LastingLink, WhoDoesNotComeInTimeIsNotWaitedFor) {
  const Ends ends = ends_of(GetParam());
  for (const char* options : {"?readers=2&stay=1&wait=1", "?readers=2&wait=1"}) {
    SCOPED_TRACE(options);
    const auto sink = sink_of(ends.sink + options);
    ASSERT_TRUE(sink->send(numbered(0, 10)));  // returns after a second, without a reader
    EXPECT_EQ(sink->traffic().dropped_disconnect, 1U);
    std::unique_ptr<Source> source;
    EXPECT_EQ(first_of_next_reader(*sink, ends.source, 1, source), 1);  // without a second reader
  }
  const auto sink = sink_of(ends.sink + "?readers=1&wait=1");
  EXPECT_TRUE(sink->close());
}

TEST_P(LastingLink, WithoutStayItEndsWithItsReaders) {
  begin("&keep=latest");
  source_.reset();
  Status sent;
  while (sent) sent = sink_->send(numbered(1, 10));
  EXPECT_EQ(sent.error().code, Code::Closed);
}

TEST_P(LastingLink, ASourceThatIsToFinishTakesWhatIsLeftAndEnds) {
  begin("", "?reconnect=60");
  ASSERT_TRUE(sink_->send(numbered(1, 10)));
  ASSERT_TRUE(sink_->close());
  source_->finish();
  EXPECT_EQ(next(*source_).header.seq, 1);
  EXPECT_FALSE(*receive(*source_, message_));
  EXPECT_EQ(*source_->take(message_), Got::End);
}

TEST_P(LastingLink, ASourceWithoutAConnectionFinishesAtOnce) {
  auto source = source_of(ends_.source + "?reconnect=60");
  Message message;
  ASSERT_EQ(*source->take(message), Got::Nothing);
  source->finish();
  EXPECT_EQ(*source->take(message), Got::End);
}

TEST_P(LastingLink, AnEndThatIsFollowedByItsOwnIsNotLogged) {
  begin("", "?reconnect=60");
  sink_.reset();
  while (!*source_->wait(-1, std::chrono::milliseconds(0))) {
  }
  ASSERT_EQ(*source_->take(message_), Got::Nothing);
  source_->finish();
  EXPECT_EQ(*source_->take(message_), Got::End);
  EXPECT_EQ(warnings_.lines, std::vector<std::string>());
}

TEST_P(LastingLink, StayIsYesOrNo) {
  EXPECT_EQ(open_sink(*parse_uri(ends_.sink + "?stay=2")).error().code, Code::Invalid);
}

}  // namespace
}  // namespace hc::testing
