// SPDX-License-Identifier: Apache-2.0
#include <hc/testing/socket_link.h>

#include <sys/eventfd.h>
#include <sys/resource.h>

namespace hc::testing {

TEST_P(SocketLink, IsRefusedWhereNobodyListens) {
  EXPECT_EQ(refused(open_source(*parse_uri(dial()))).code, Code::Closed);
  EXPECT_FALSE(open_sink(*parse_uri(dial())));
}

TEST_P(SocketLink, ANameInUseIsRefused) {
  auto first = source_of(listen());
  EXPECT_EQ(refused(open_source(*parse_uri(listen()))).code, Code::System);
}

TEST_P(SocketLink, ASecondListenerTakesNoReadersPlace) {
  Stop stop;
  stop.raise();  // or the sink would wait for its reader forever
  auto sink = sink_of(with(listen(), "readers=1"), stop.options());
  EXPECT_FALSE(open_sink(*parse_uri(listen())));
  EXPECT_EQ(sink->send(numbered(0, 10)).error().code, Code::Stopped);
}

TEST_P(SocketLink, WaitsForAListener) {
  std::thread late([&] {
    auto sink = sink_of(with(listen(), "readers=1"));
    ASSERT_TRUE(sink->close());
  });
  auto source = source_of(with(dial(), "wait=60"));
  Message message;
  EXPECT_FALSE(*receive(*source, message));
  late.join();
}

TEST_P(SocketLink, WaitingEndsWhenAskedToStop) {
  Stop stop;
  stop.raise();
  auto options = stop.options();
  EXPECT_EQ(open_source(*parse_uri(with(dial(), "wait=60")), options).error().code, Code::Stopped);
  auto sink = sink_of(listen(), options);
  EXPECT_EQ(sink->send(numbered(0, 1)).error().code, Code::Stopped);
}

TEST_P(SocketLink, WritersComeAndGo) {
  auto source = source_of(listen());
  for (int i = 0; i < 5; ++i) {
    auto sink = sink_of(dial());
    ASSERT_TRUE(sink->send(numbered(i, 10)));
    ASSERT_TRUE(sink->close());
    EXPECT_EQ(next(*source).header.seq, i);
  }
  EXPECT_EQ(source->traffic().messages, 5U);
}

TEST_P(SocketLink, ReadersComeAndGo) {
  auto sink = sink_of(listen());
  for (int i = 0; i < 5; ++i) {
    std::unique_ptr<Source> source;
    EXPECT_EQ(first_of_next_reader(*sink, dial(), i, source), i);
  }
}

// Messages that are sent before that is noticed are lost: a few at most.
TEST_P(SocketLink, AfterAReaderHasLeftTheNextIsWaitedFor) {
  Stop stop;
  auto sink = sink_of(listen(), stop.options());
  auto source = source_of(dial());
  ASSERT_TRUE(sink->send(numbered(0, 10)));
  next(*source);
  source.reset();
  stop.raise();  // or it would wait for the next reader for ever
  Status sent;
  while (sent) sent = sink->send(numbered(1, 10));
  EXPECT_EQ(sent.error().code, Code::Stopped);
  source = source_of(dial());
  ASSERT_TRUE(sink->send(numbered(2, 10)));
  EXPECT_EQ(next(*source).header.seq, 2);
}

// As `nc -N` does at the end of its standard input.
TEST_P(SocketLink, AReaderThatHasShutItsOwnSideReadsOn) {
  auto sink = sink_of(listen());
  auto peer = GetParam().connect(place_);
  ASSERT_EQ(::shutdown(peer.get(), SHUT_WR), 0);
  auto sender = send_all(*sink, 20, 100'000);
  internal::StreamSource source({std::move(peer)}, {});
  for (int i = 0; i < 20; ++i) EXPECT_EQ(next(source).header.seq, i);
  Message message;
  EXPECT_FALSE(*receive(source, message));
  sender.join();
}

TEST_P(SocketLink, ManyReadersGetEachMessage) {
  auto sink = sink_of(with(listen(), "readers=4"));
  std::vector<std::unique_ptr<Source>> sources;
  for (int i = 0; i < 4; ++i) sources.push_back(source_of(dial()));
  auto sender = send_all(*sink, 20, 1000);
  for (int i = 0; i < 20; ++i)
    for (auto& source : sources) EXPECT_EQ(next(*source).header.seq, i);
  sender.join();
  EXPECT_EQ(sink->traffic().messages, 20U);
}

TEST_P(SocketLink, AHostilePeerDisturbsNobody) {
  Warnings warnings;
  auto source = source_of(listen(), warnings.options());
  auto hostile = GetParam().connect(place_);
  auto sink = sink_of(dial());
  write_to(hostile, "GET / HTTP/1.1\r\n");
  for (int i = 0; i < 10 || warnings.lines.empty(); ++i) {  // data may arrive later
    ASSERT_TRUE(sink->send(numbered(i, 10)));
    EXPECT_EQ(next(*source).header.seq, i);
  }
  ASSERT_EQ(warnings.lines.size(), 1U);
  EXPECT_EQ(warnings.lines[0],
            listen() +
                ": closed a connection: Malformed: R5 version: \"GET\" is not an "
                "integer, at byte 0");
}

TEST_P(SocketLink, AMessageThatIsCutIsReported) {
  Warnings warnings;
  auto source = source_of(listen(), warnings.options());
  std::string bytes = encode(numbered(1, 100)) + encode(numbered(2, 100)).substr(0, 60);
  {
    auto peer = GetParam().connect(place_);
    for (char c : bytes) write_to(peer, {&c, 1});  // one byte at a time
  }
  Message message;
  EXPECT_EQ(next(*source).text(), numbered(1, 100).text());
  auto sink = sink_of(dial());
  ASSERT_TRUE(sink->send(numbered(3, 1)));
  EXPECT_EQ(next(*source).header.seq, 3);
  while (warnings.lines.empty()) ASSERT_EQ(*source->take(message), Got::Nothing);
  EXPECT_NE(
      warnings.lines[0].find(": closed a connection: Truncated: R2 stream: truncated in message 2"),
      std::string::npos);
}

/// Leaves the process this many free descriptors during its lifetime.
class NoDescriptors {
 public:
  explicit NoDescriptors(rlim_t but = 0) {
    ::getrlimit(RLIMIT_NOFILE, &saved_);
    Descriptor lowest(::eventfd(0, EFD_CLOEXEC));
    rlimit none = {static_cast<rlim_t>(lowest.get()) + but, saved_.rlim_max};
    EXPECT_EQ(::setrlimit(RLIMIT_NOFILE, &none), 0);
  }
  ~NoDescriptors() { ::setrlimit(RLIMIT_NOFILE, &saved_); }

 private:
  rlimit saved_{};
};

/// Starts the background thread of links, whose descriptors stay open.
static void start_link_thread() {
  ASSERT_TRUE(Watch().start(-1, [](auto) {}));
}

constexpr int kPeersThatLeave = static_cast<int>(internal::kMaxPeers) + 20;

TEST_P(SocketLink, AWriterThatLeftIsForgotten) {
  start_link_thread();
  Warnings warnings;
  auto source = source_of(listen(), warnings.options());
  const auto before = open_descriptors();
  Message message;
  for (int i = 0; i < kPeersThatLeave; ++i) {
    auto sink = sink_of(dial());
    ASSERT_TRUE(sink->send(numbered(i, 1)));
    ASSERT_TRUE(sink->close());
    sink.reset();
    ASSERT_TRUE(*receive(*source, message));
    while (open_descriptors() > before) ASSERT_EQ(*source->take(message), Got::Nothing);
  }
  EXPECT_TRUE(warnings.lines.empty()) << warnings.lines.front();
  EXPECT_EQ(source->traffic().messages, static_cast<std::uint64_t>(kPeersThatLeave));
}

TEST_P(SocketLink, AReaderThatLeftIsForgotten) {
  start_link_thread();
  auto sink = sink_of(with(listen(), "readers=1&stay=1&keep=latest"));
  const auto before = open_descriptors();
  for (int i = 0; i < kPeersThatLeave; ++i) {
    auto source = source_of(dial());
    ASSERT_TRUE(sink->send(numbered(i, 1)));
    next(*source);
    source.reset();
    while (open_descriptors() > before) ASSERT_TRUE(sink->send(numbered(i, 1)));
  }
}

TEST_P(SocketLink, WithNoReadersToWaitForItNeverWaits) {
  auto sink = sink_of(with(listen(), "readers=0"));
  ASSERT_TRUE(sink->send(numbered(1, 1)));
  EXPECT_EQ(sink->traffic().dropped_disconnect, 1U);
  auto source = source_of(dial());
  ASSERT_TRUE(sink->send(numbered(2, 1)));
  EXPECT_EQ(next(*source).header.seq, 2);
  source.reset();
  while (sink->traffic().dropped_disconnect < 3) ASSERT_TRUE(sink->send(numbered(3, 1)));
  EXPECT_TRUE(sink->close());
}

TEST_P(AcceptingLink, WhoComesWhenDescriptorsHaveRunOutIsLetInLater) {
  Warnings warnings;
  auto source = source_of(listen(), warnings.options());
  auto sink = sink_of(dial());
  ASSERT_TRUE(sink->send(numbered(1, 1)));
  EXPECT_EQ(source->traffic().messages, 0U);  // UBSan needs descriptors for a first call
  Message message;
  {
    NoDescriptors none;
    for (int i = 0; i < 3; ++i) ASSERT_EQ(*source->take(message), Got::Nothing);
  }
  EXPECT_EQ(warnings.lines,
            std::vector<std::string>{listen() + ": not accepting connections: System: accept(): "
                                                "Too many open files; retrying every 200 ms"});
  EXPECT_TRUE(*receive(*source, message));
}

TEST_P(AcceptingLink, AReaderThatComesWhenDescriptorsHaveRunOutIsLetInLater) {
  Warnings warnings;
  auto options = warnings.options();
  Stop stop;
  stop.raise();
  options.stop = stop.options().stop;
  auto sink = sink_of(listen(), options);
  std::unique_ptr<Source> source;
  EXPECT_EQ(sink->traffic().messages, 0U);  // UBSan needs descriptors for a first call
  Message first = numbered(1, 1);
  {
    NoDescriptors none(1);
    source = source_of(dial());  // takes the only one
    EXPECT_EQ(sink->send(first).error().code, Code::Stopped);
  }
  EXPECT_EQ(warnings.lines,
            std::vector<std::string>{listen() + ": not accepting connections: System: accept(): "
                                                "Too many open files; retrying every 200 ms"});
  ASSERT_TRUE(sink->send(numbered(2, 1)));
  EXPECT_EQ(next(*source).header.seq, 2);
}

/// The end of the header of an encoded message, where a peer may stop sending.
static std::size_t head_of(const std::string& message) {
  return message.find('\n') + 1;
}

/// Sends a message and the header of the next one; returns when the source has read both.
static void enter_message(const Descriptor& peer, Source& source) {
  std::string message = encode(numbered(0, 1));
  std::string bytes = message + message.substr(0, head_of(message));
  write_to(peer, bytes);
  next(source);
}

TEST_P(SocketLink, WhoIsSilentLongestMakesRoom) {
  Warnings warnings;
  auto source = source_of(listen(), warnings.options());
  std::vector<Descriptor> peers;
  Message message;
  for (std::size_t i = 0; i < internal::kMaxPeers; ++i) {
    peers.push_back(GetParam().connect(place_));
    ASSERT_EQ(*source->take(message), Got::Nothing);
    if (i == 1) enter_message(peers[1], *source);
  }
  // The first peer has sent something since, and the second is inside a message.
  write_to(peers[0], encode(numbered(1, 1)));
  next(*source);
  auto sink = sink_of(with(dial(), "wait=60"));
  ASSERT_TRUE(sink->send(numbered(2, 1)));
  EXPECT_EQ(next(*source).header.seq, 2);
  ASSERT_EQ(warnings.lines.size(), 1U);
  EXPECT_EQ(warnings.lines[0],
            listen() + ": closed the peer that was silent longest, to make room for a new one");
  EXPECT_TRUE(is_closed(peers[2]));
}

TEST_P(SocketLink, WhoDoesNotEndItsHeaderIsClosed) {
  EXPECT_EQ(internal::PeerTimes().header, std::chrono::seconds(5));
  Warnings warnings;
  auto source = source_with({.header = std::chrono::seconds(0)}, warnings);
  auto peer = GetParam().connect(place_);
  write_to(peer, "1 2");
  await_warning(*source, warnings);
  EXPECT_EQ(warnings.lines[0], "closed a connection: no complete header in 0 s");
  EXPECT_TRUE(is_closed(peer));
  auto sink = sink_of(dial());
  ASSERT_TRUE(sink->send(numbered(1, 1)));
  next(*source);
}

TEST_P(AcceptingLink, AHeaderThatCameWhileItsReaderWasBusyIsNotLate) {
  Warnings warnings;
  const auto source = source_with({.header = std::chrono::seconds(0)}, warnings);
  const auto peer = GetParam().connect(place_);
  const std::string whole = encode(numbered(1, 1));
  write_to(peer, whole + whole.substr(0, 3));
  Message message = next(*source);
  ASSERT_EQ(*source->take(message), Got::Nothing);
  write_to(peer, whole.substr(3));
  EXPECT_EQ(next(*source).header.seq, 1);
  EXPECT_EQ(warnings.lines, std::vector<std::string>());
}

TEST_P(SocketLink, WhoIsInsideAMessageKeepsItsPlace) {
  auto source = source_of(listen());
  std::vector<Descriptor> peers;
  std::string bytes = encode(numbered(1, 1));
  Message message;
  for (std::size_t i = 0; i < internal::kMaxPeers; ++i) {
    peers.push_back(GetParam().connect(place_));
    enter_message(peers[i], *source);
  }
  auto sink = sink_of(with(dial(), "wait=60"));
  ASSERT_TRUE(sink->send(numbered(2, 1)));
  EXPECT_EQ(*source->take(message), Got::Nothing);
  write_to(peers[7], bytes.substr(head_of(bytes)));
  EXPECT_EQ(next(*source).text(), numbered(1, 1).text());
  EXPECT_EQ(next(*source).header.seq, 2);  // from the last writer, which replaced the seventh
}

TEST_P(SocketLink, WhoIsSilentForLongInsideAMessageGivesItsPlaceToOneWhoWaits) {
  EXPECT_EQ(internal::PeerTimes().silence, std::chrono::seconds(30));
  Warnings warnings;
  auto source = source_with({.silence = std::chrono::seconds(0)}, warnings);
  std::vector<Descriptor> peers;
  Message message;
  for (std::size_t i = 0; i < internal::kMaxPeers; ++i) {
    peers.push_back(GetParam().connect(place_));
    enter_message(peers[i], *source);
  }
  ASSERT_EQ(*source->take(message), Got::Nothing);
  EXPECT_TRUE(warnings.lines.empty());  // no other peer is waiting
  auto sink = sink_of(with(dial(), "wait=60"));
  ASSERT_TRUE(sink->send(numbered(2, 1)));
  EXPECT_EQ(next(*source).header.seq, 2);
  EXPECT_EQ(warnings.lines,
            std::vector<std::string>{
                "closed the peer that was silent longest, to make room for a new one"});
  EXPECT_TRUE(is_closed(peers[0]));
}

TEST_P(SocketLink, MoreReadersThanThereIsRoomForWait) {
  auto sink = sink_of(listen());
  std::vector<Descriptor> peers;
  for (std::size_t i = 0; i < internal::kMaxPeers; ++i) {
    peers.push_back(GetParam().connect(place_));
    ASSERT_TRUE(sink->send(numbered(0, 1)));
  }
  auto last = GetParam().connect(place_);
  char byte = 0;
  ASSERT_TRUE(sink->send(numbered(1, 1)));
  EXPECT_EQ(::recv(last.get(), &byte, 1, MSG_DONTWAIT), -1);
  peers.erase(peers.begin());
  // The others read nothing, so that the writer is blocked after few messages.
  pollfd polled{last.get(), POLLIN, 0};
  do {
    ASSERT_TRUE(sink->send(numbered(2, 1)));
  } while (::poll(&polled, 1, 50) == 0);
  EXPECT_EQ(::recv(last.get(), &byte, 1, MSG_DONTWAIT), 1);
}

TEST_P(SocketLink, OneSlowReaderHoldsUpNoOther) {
  auto sink = sink_of(with(listen(), "readers=2&keep=latest"));
  auto slow = GetParam().connect(place_);
  auto source = source_of(dial());
  // The fast reader reads until the slow one must have missed messages.
  for (int i = 0; sink->traffic().lost() < 10; ++i) {
    ASSERT_TRUE(sink->send(numbered(i, 100'000)));
    EXPECT_EQ(next(*source).header.seq, i);
  }
}

TEST_P(SocketLink, EveryStreamThatIsCutIsLoggedOnce) {
  std::minstd_rand random(1);
  Warnings warnings;
  auto source = source_of(listen(), warnings.options());
  const std::string bytes = encode(numbered(1, 100)) + encode(numbered(2, 100));
  const std::size_t half = encode(numbered(1, 100)).size();
  Message message;
  std::size_t messages = 0, cut = 0;
  auto take_all = [&] {
    while (*source->take(message) == Got::Message) ++messages;
  };
  std::size_t expected = 0;
  for (int i = 0; i < GetParam().cuts; ++i) {
    std::size_t size = random() % bytes.size();
    auto peer = GetParam().connect(place_);
    ASSERT_EQ(::send(peer.get(), bytes.data(), size, 0), static_cast<ssize_t>(size));
    if (size % half != 0) ++cut;
    expected += size / half;
    take_all();
  }
  while (warnings.lines.size() < cut || messages < expected) take_all();
  take_all();
  EXPECT_EQ(warnings.lines.size(), cut);
  EXPECT_EQ(messages, expected);
  for (const auto& line : warnings.lines)
    EXPECT_NE(line.find("Truncated: R2"), std::string::npos) << line;
}

}  // namespace hc::testing
