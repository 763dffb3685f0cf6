// SPDX-License-Identifier: Apache-2.0
// Tests of tcp and unix links that survive the loss of their connections.

#include <memory>
#include <thread>

#include <hc/link/stream/dialer.h>
#include <hc/os/wait_readable.h>
#include <hc/testing/socket_link.h>

namespace hc::testing {

TEST_P(SocketLink, ASourceMayBeThereBeforeAnyWriter) {
  auto source = source_of(with(dial(), "reconnect=60"));
  Message message;
  EXPECT_EQ(*source->take(message), Got::Nothing);
  const int descriptor = source->descriptor();
  for (int i = 0; i < 3; ++i) {  // survives several writers
    auto sink = sink_of(with(listen(), "readers=1"));
    EXPECT_EQ(carry(*sink, *source, numbered(i, 10)).header.seq, i);
  }
  EXPECT_EQ(source->descriptor(), descriptor);
  EXPECT_EQ(source->traffic().messages, 3U);
}

TEST_P(SocketLink, ALossIsLoggedAndItsEnd) {
  Warnings warnings;
  auto source = source_of(with(dial(), "reconnect=60"), warnings.options());
  for (int i = 0; i < 2; ++i) {
    carry(*sink_of(with(listen(), "readers=1")), *source, numbered(i, 10));
    await_warning(*source, warnings);
  }
  EXPECT_EQ(warnings.lines, (std::vector<std::string>{
                                with(dial(), "reconnect=60") + ": sender closed; reconnecting",
                                with(dial(), "reconnect=60") + ": reconnected"}));
}

TEST_P(SocketLink, GarbageIsTheEndOfAConnectionAndNotOfTheLink) {
  Warnings warnings;
  auto options = warnings.options();
  options.limits.element_bytes = 1000;
  auto source = source_of(with(dial(), "reconnect=60"), options);
  Message message;
  for (int i = 0; i < 2; ++i) {
    auto sink = sink_of(with(listen(), "readers=1"));
    std::thread sender([&] {
      ASSERT_TRUE(sink->send(numbered(i, 10)));
      if (i == 0) static_cast<void>(sink->send(numbered(9, 2000)));  // its header exceeds the limit
    });
    EXPECT_EQ(next(*source).header.seq, i);
    while (i == 0 && source->traffic().bad == 0) {
      ASSERT_EQ(*source->take(message), Got::Nothing);
      ASSERT_TRUE(source->wait());
    }
    sender.join();
  }
  EXPECT_EQ(source->traffic().bad, 1U);
  EXPECT_NE(warnings.lines.at(0).find("TooLarge: "), std::string::npos) << warnings.lines[0];
}

TEST_P(SocketLink, BehindAConnectionThatLivedPausesAreShortAgain) {
  internal::TimePoint now{std::chrono::seconds(1000)};  // advanced by the test
  constexpr std::chrono::seconds kPatience(600);
  internal::Dialer dialer(*GetParam().peer(*parse_uri(dial())), kPatience, kPatience, now);
  for (int i = 0; i < 10; ++i) {
    for (int failures = 0; failures < 9;
         now = dialer.due(), ++failures) {  // until the pauses are long
      do ASSERT_FALSE(*dialer.dial(now));
      while (dialer.descriptor() >= 0);
    }
    auto listening = *GetParam().socket(*parse_uri(listen()), {});
    auto connection = *dialer.dial(now);
    for (; !connection; connection = *dialer.dial(now)) {
      ASSERT_GE(dialer.descriptor(), 0) << dialer.why();
      ASSERT_TRUE(wait_for(dialer.descriptor(), dialer.events(), -1));
    }
    now += internal::kFirstPause;
    dialer.lost(now, false, "it was killed");
    ASSERT_LE(dialer.due() - now, internal::kFirstPause);
  }
}

TEST_P(SocketLink, ASinkThatLosesNothingWaitsForEachReader) {
  auto sink = sink_of(with(dial(), "reconnect=60"));
  std::thread sender([&] { ASSERT_TRUE(sink->send(numbered(0, 10))); });
  auto source = source_of(listen());
  EXPECT_EQ(next(*source).header.seq, 0);
  sender.join();
}

TEST_P(SocketLink, AMessageThatWasBegunIsSentAnewToTheNextReader) {
  auto sink = sink_of(with(dial(), "reconnect=60"));
  Warnings warnings;
  auto options = warnings.options();
  options.limits.element_bytes = 1000;  // closes the connection inside the message
  auto source = source_of(listen(), options);
  std::thread sender([&] {
    ASSERT_TRUE(sink->send(numbered(0, 10'000'000)));
    ASSERT_TRUE(sink->close());
  });
  await_warning(*source, warnings);
  source.reset();
  source = source_of(listen());
  EXPECT_EQ(next(*source).text(), numbered(0, 10'000'000).text());
  sender.join();
  EXPECT_EQ(sink->traffic().dropped_disconnect, 0U);
}

TEST_P(SocketLink, ASinkThatKeepsTheLatestWaitsForNobody) {
  auto sink = sink_of(with(dial(), "reconnect=60&keep=latest"));
  for (int i = 0; i < 10; ++i) ASSERT_TRUE(sink->send(numbered(i, 10)));
  EXPECT_EQ(sink->traffic().dropped_newer, 9U);
  auto source = source_of(listen());
  EXPECT_EQ(next(*source).header.seq, 9);  // without sending more
}

TEST_P(SocketLink, WhoNeverFindsAnybodySaysSo) {
  std::vector<std::pair<std::unique_ptr<Source>, std::unique_ptr<Sink>>>
      links;  // all wait at the same time
  for (const char* options : {"reconnect=1", "reconnect=86400&wait=1"})
    links.emplace_back(source_of(with(dial(), options)), sink_of(with(dial(), options)));
  for (const auto& [source, sink] : links) {
    Message message;
    const auto got = refused(receive(*source, message));
    EXPECT_TRUE(got.text().starts_with("NotFound: no peer for 1 s: ")) << got.text();
    EXPECT_EQ(*source->take(message), Got::End);
    EXPECT_EQ(sink->send(numbered(0, 1)).error().code, Code::NotFound);
  }
}

TEST_P(SocketLink, WhoFindsNobodyAnyMoreGivesUp) {
  Warnings warnings;
  std::unique_ptr<Source> source;
  std::unique_ptr<Sink> sink;
  Message message;
  {
    auto writer = sink_of(listen());
    source = source_of(with(dial(), "reconnect=1"), warnings.options());
    carry(*writer, *source, numbered(0, 1));
  }
  EXPECT_FALSE(*receive(*source, message));
  ASSERT_EQ(warnings.lines.size(), 2U);
  EXPECT_EQ(warnings.lines[0], with(dial(), "reconnect=1") + ": sender closed; reconnecting");
  EXPECT_TRUE(warnings.lines[1].starts_with(with(dial(), "reconnect=1") + ": no peer for 1 s: "));
  {
    auto reader = source_of(listen());
    sink = sink_of(with(dial(), "reconnect=1"));
    ASSERT_TRUE(sink->send(numbered(0, 1)));
    next(*reader);
  }
  Status sent;
  while (sent) sent = sink->send(numbered(0, 1));
  EXPECT_EQ(sent.error().code, Code::Closed);
}

TEST_P(SocketLink, WhoWaitsLongForSomebodyIsLoggedOnce) {
  Warnings warnings;
  auto source = source_of(with(dial(), "reconnect=60"), warnings.options());
  Message message;
  auto wait = [&] {
    ASSERT_TRUE(source->wait());
    ASSERT_EQ(*source->take(message), Got::Nothing);
  };
  while (warnings.lines.empty()) wait();
  wait();  // another failed attempt; the pauses have become long
  EXPECT_EQ(warnings.lines.size(), 1U);
  EXPECT_TRUE(warnings.lines[0].starts_with(with(dial(), "reconnect=60") + ": no peer yet ("))
      << warnings.lines[0];
  auto sink = sink_of(listen());
  while (warnings.lines.size() < 2) wait();
  EXPECT_EQ(warnings.lines[1], with(dial(), "reconnect=60") + ": connected");
}

TEST_P(SocketLink, AWriterThatWaitsForSomebodyIsInterrupted) {
  Stop stop;
  auto options = stop.options();
  int lines = 0;
  options.log = [&](Level, std::string_view) {
    ++lines;
    stop.raise();
  };
  auto sink = sink_of(with(dial(), "reconnect=60"), options);
  EXPECT_EQ(sink->send(numbered(0, 1)).error().code, Code::Stopped);
  EXPECT_EQ(lines, 1);
}

TEST_P(SocketLink, ConnectingEndsWhenAskedToStop) {
  Stop stop;
  stop.raise();
  auto sink = sink_of(with(dial(), "reconnect=60"), stop.options());
  EXPECT_EQ(sink->send(numbered(0, 1)).error().code, Code::Stopped);
  auto source = source_of(with(dial(), "reconnect=60"));
  Message message;
  EXPECT_EQ(receive(*source, message, stop.options().stop).error().code, Code::Stopped);
}

}  // namespace hc::testing
