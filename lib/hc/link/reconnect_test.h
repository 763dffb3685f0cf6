// SPDX-License-Identifier: Apache-2.0
#pragma once
// What tcp and unix links do that outlive their connections.

#include <memory>
#include <thread>

#include <hc/link/socket_test.h>

namespace hc::testing {

TEST_P(SocketLink, ASourceMayBeThereBeforeAnyWriter) {
  auto source = source_of(dial() + "?reconnect=60");
  Message message;
  EXPECT_EQ(*source->take(message), Got::Nothing);
  const int descriptor = source->descriptor();
  for (int i = 0; i < 3; ++i) {  // and outlives several
    auto sink = sink_of(listen() + "?readers=1");
    std::thread sender([&] { ASSERT_TRUE(sink->send(numbered(i, 10))); });
    ASSERT_TRUE(*receive(*source, message));
    EXPECT_EQ(message.header.seq, i);
    sender.join();
  }
  EXPECT_EQ(source->descriptor(), descriptor);
  EXPECT_EQ(source->traffic().messages, 3U);
}

TEST_P(SocketLink, ASinkThatLosesNothingWaitsForEachReader) {
  auto sink = sink_of(dial() + "?reconnect=60");
  std::thread sender([&] { ASSERT_TRUE(sink->send(numbered(0, 10))); });
  auto source = source_of(listen());
  Message message;
  ASSERT_TRUE(*receive(*source, message));
  EXPECT_EQ(message.header.seq, 0);
  sender.join();
}

TEST_P(SocketLink, AMessageThatWasBegunIsSentAnewToTheNextReader) {
  auto sink = sink_of(dial() + "?reconnect=60");
  Warnings warnings;
  auto options = warnings.options();
  options.limits.element_bytes = 1000;  // so that it closes a connection inside the message
  auto source = source_of(listen(), options);
  std::thread sender([&] {
    ASSERT_TRUE(sink->send(numbered(0, 10'000'000)));
    ASSERT_TRUE(sink->close());
  });
  Message message;
  while (warnings.lines.empty()) {
    ASSERT_TRUE(source->wait(-1, std::chrono::milliseconds(-1)));
    ASSERT_EQ(*source->take(message), Got::Nothing);
  }
  source.reset();
  source = source_of(listen());
  ASSERT_TRUE(*receive(*source, message));
  EXPECT_EQ(message.characters(), numbered(0, 10'000'000).characters());
  sender.join();
  EXPECT_EQ(sink->traffic().cut, 0U);
}

TEST_P(SocketLink, ASinkThatKeepsTheLatestWaitsForNobody) {
  auto sink = sink_of(dial() + "?reconnect=60&keep=latest");
  for (int i = 0; i < 10; ++i) ASSERT_TRUE(sink->send(numbered(i, 10)));
  EXPECT_EQ(sink->traffic().superseded, 9U);
  auto source = source_of(listen());
  Message message;
  ASSERT_TRUE(*receive(*source, message));  // nothing more needs to be sent
  EXPECT_EQ(message.header.seq, 9);
}

TEST_P(SocketLink, WhoFindsNobodyGivesUp) {
  auto source = source_of(dial() + "?reconnect=1");
  auto sink = sink_of(dial() + "?reconnect=1");
  Message message;
  EXPECT_FALSE(*receive(*source, message));
  EXPECT_EQ(sink->send(numbered(0, 1)).error().code, Code::Closed);
}

TEST_P(SocketLink, ConnectingEndsWhenToldToStop) {
  Stop stop;
  stop.raise();
  auto sink = sink_of(dial() + "?reconnect=60", stop.options());
  EXPECT_EQ(sink->send(numbered(0, 1)).error().code, Code::Stopped);
  auto source = source_of(dial() + "?reconnect=60");
  Message message;
  EXPECT_EQ(receive(*source, message, stop.options().stop).error().code, Code::Stopped);
}

}  // namespace hc::testing
