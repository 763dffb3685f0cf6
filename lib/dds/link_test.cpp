// SPDX-License-Identifier: Apache-2.0
// DDS links: the conformance suite, and links with several readers and writers.
#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <functional>
#include <vector>

#include <dds/stranger_test.h>
#include <dds/transport.h>

namespace hc::testing {
namespace {

/// A topic that is unique among tests and concurrent runs.
std::string fresh_topic() {
  static int number = 0;
  return "dds:test/t" + std::to_string(::getpid()) + "_" + std::to_string(number++) + "?domain=97";
}

INSTANTIATE_TEST_SUITE_P(Dds, LinkConformance,
                         ::testing::Values(Transport{"dds", [] {
                                                       const auto uri = fresh_topic();
                                                       return std::pair{uri, uri + "&readers=1"};
                                                     }}));

/// Runs this program as another process that reads or writes a link until it ends.
class Child {
 public:
  Child(const char* what, const std::string& uri) : process_(::fork()) {
    if (process_ != 0) return;
    ::execl("/proc/self/exe", "dds_link_test", what, uri.c_str(), nullptr);
    ::_exit(1);
  }
  ~Child() { kill(); }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  void kill() {
    if (process_ <= 0) return;
    ::kill(process_, SIGKILL);
    ::waitpid(std::exchange(process_, 0), nullptr, 0);
  }

  static void read(const std::string& uri) {
    const auto source = source_of(uri);
    Message message;
    while (*receive(*source, message)) continue;
  }
  static void write(const std::string& uri) {
    const auto sink = sink_of(uri);
    for (int i = 0; sink->send(numbered(i, 1000)); ++i) continue;
  }

 private:
  pid_t process_;
};

TEST(Dds, AllReadersGetEachMessage) {
  constexpr int kCount = 100;
  const auto uri = fresh_topic();
  std::vector<std::unique_ptr<Source>> sources;
  for (int i = 0; i < 3; ++i) sources.push_back(source_of(uri));
  const auto sink = sink_of(uri + "&readers=3");
  const auto size = [](int i) { return i % 10 == 9 ? 100'000 : i; };
  auto sender = send_all(*sink, kCount, size);
  for (int i = 0; i < kCount; ++i)
    for (const auto& source : sources) EXPECT_EQ(next(*source).text(), numbered(i, size(i)).text());
  Message message;
  for (const auto& source : sources) EXPECT_FALSE(*receive(*source, message));
  sender.join();
}

/// Sends messages so fast that some share samples.
void send_together(Sink& sink, int count, const std::function<std::int32_t(int)>& size,
                   int src = 0) {
  std::vector<Message> messages;
  for (int i = 0; i < count; ++i) messages.push_back(numbered(i, size(i)));
  for (auto& message : messages) message.header.src = src;
  for (const auto& message : messages) ASSERT_TRUE(sink.send(message));
}

TEST(Dds, WhatSharesASampleArrivesThoughNoMoreFollows) {
  const auto uri = fresh_topic();
  const auto source = source_of(uri);
  SampleCounter samples(uri);
  const auto sink = sink_of(uri + "&readers=2");
  int sent = 0;
  for (const int count : {1, 2, 10, 1000, 1}) {
    send_together(*sink, count, [](int i) { return i % 500; });
    sent += count;
    for (int i = 0; i < count; ++i) EXPECT_EQ(encode(next(*source)), encode(numbered(i, i % 500)));
  }
  ASSERT_TRUE(sink->close());
  const int count = samples.count();
  EXPECT_GE(count, 5);
  EXPECT_LT(count, sent);
}

TEST(Dds, ASharedSampleMayBeLargerThanTheLargestMessage) {
  constexpr int kCount = 1000;
  const auto uri = fresh_topic();
  LinkOptions options;
  options.limits.element_bytes = 100;
  const auto source = source_of(uri, options);
  SampleCounter samples(uri);
  const auto sink = sink_of(uri + "&readers=2", options);
  std::thread sender([&] {
    send_together(*sink, kCount, [](int) { return 100; });
    EXPECT_TRUE(sink->close());
  });
  Message message;
  int received = 0;
  while (*receive(*source, message)) EXPECT_EQ(message.header.seq, received++);
  sender.join();
  EXPECT_EQ(received, kCount);
  EXPECT_LT(samples.count(), kCount);
}

TEST(Dds, OfASharedSampleWhoKeepsTheLatestGetsTheLast) {
  constexpr int kCount = 1000;
  const auto uri = fresh_topic();
  const auto source = source_of(uri + "&keep=latest");
  SampleCounter samples(uri);
  const auto sink = sink_of(uri + "&readers=2");
  send_together(*sink, kCount, [](int) { return 10; });
  ASSERT_TRUE(sink->close());
  const int count = samples.count();
  EXPECT_GE(count, 1);
  EXPECT_LT(count, kCount);
  Message message;
  EXPECT_EQ(next(*source).header.seq, kCount - 1);
  EXPECT_EQ(source->traffic().dropped_newer, kCount - 1U);
  EXPECT_FALSE(*receive(*source, message));
  EXPECT_EQ(sink->traffic().messages, std::uint64_t{kCount});
}

TEST(Dds, WhatIsDeliveredIsNotCountedAsCut) {
  constexpr std::size_t kSinks = 50;
  const auto uri = fresh_topic();
  const auto source = source_of(uri);
  const auto keeper = sink_of(uri + "&readers=1");  // keeps the source from ending
  std::array<std::uint64_t, kSinks> received{};
  std::jthread receiver([&] {
    Message message;
    while (*receive(*source, message)) ++received.at(static_cast<std::size_t>(message.header.src));
  });
  std::array<Traffic, kSinks> sent;
  for (std::size_t i = 0; i < kSinks; ++i) {
    const auto sink = sink_of(uri + "&readers=1");
    send_together(
        *sink, 900, [](int) { return 100; }, static_cast<int>(i));
    if (i > 0) sink->abandon();
    EXPECT_TRUE(sink->close());
    sent.at(i) = sink->traffic();
  }
  EXPECT_TRUE(keeper->close());
  receiver.join();
  std::uint64_t cut = 0;
  for (std::size_t i = 0; i < kSinks; ++i) {
    EXPECT_LE(received.at(i), sent.at(i).messages - sent.at(i).dropped_disconnect) << i;
    cut += sent.at(i).dropped_disconnect;
  }
  EXPECT_EQ(received.at(0), 900U);  // it was closed, not abandoned
  // Some of the others were abandoned with samples in transit.
  EXPECT_GT(cut, 0U);
}

TEST(Dds, AllWritersAreRead) {
  const auto uri = fresh_topic();
  const auto source = source_of(uri);
  std::vector<std::unique_ptr<Sink>> sinks;
  for (int i = 0; i < 3; ++i) sinks.push_back(sink_of(uri + "&readers=1"));
  Message message;
  for (int i = 0; i < 3; ++i) {
    ASSERT_TRUE(sinks[static_cast<std::size_t>(i)]->send(numbered(i, 10)));
    EXPECT_EQ(next(*source).header.seq, i);
  }
  std::thread closer([&] {
    for (const auto& sink : sinks) ASSERT_TRUE(sink->close());
  });
  EXPECT_FALSE(*receive(*source, message));
  closer.join();
}

TEST(Dds, WhoComesLateGetsWhatIsSentFromThenOn) {
  const auto uri = fresh_topic();
  const auto sink = sink_of(uri + "&readers=1");
  const auto first = source_of(uri);
  std::unique_ptr<Source> late;
  Message message;
  std::int64_t begin = -1;
  for (int i = 0; begin < 0 || i < begin + 10; ++i) {
    ASSERT_TRUE(sink->send(numbered(i, 10)));
    EXPECT_EQ(next(*first).header.seq, i);
    if (i == 5) late = source_of(uri);
    if (begin < 0 && late && *late->take(message) == Got::Message) begin = message.header.seq;
  }
  EXPECT_GT(begin, 5);
  for (auto seq = begin + 1; seq < begin + 10; ++seq) EXPECT_EQ(next(*late).header.seq, seq);
}

TEST(Dds, AReaderMayLeaveAndComeBack) {
  const auto uri = fresh_topic();
  const auto sink = sink_of(uri + "&readers=1&stay=1&keep=latest");
  Message message;
  int sent = 0;
  for (int i = 0; i < 2; ++i) {
    auto source = source_of(uri);
    for (bool has_come = false; !has_come; has_come = *source->take(message) == Got::Message)
      ASSERT_TRUE(sink->send(numbered(sent++, 10)));
    source.reset();
    const auto before = sink->traffic().dropped_disconnect;
    while (sink->traffic().dropped_disconnect == before)
      ASSERT_TRUE(sink->send(numbered(sent++, 10)));
  }
  EXPECT_EQ(sink->traffic().messages, static_cast<std::uint64_t>(sent));
}

TEST(Dds, WhoHasLeftIsGivenUpUntilAnotherComes) {
  for (const char* options : {"&readers=1&stay=1&timeout=1", "&timeout=1"}) {
    SCOPED_TRACE(options);
    const auto uri = fresh_topic();
    const auto sink = sink_of(uri + options);
    Message message;
    for (int i = 0; i < 2; ++i) {
      auto source = source_of(uri);
      for (bool has_come = false; !has_come; has_come = *source->take(message) == Got::Message)
        ASSERT_TRUE(sink->send(numbered(i, 10)));
      source.reset();
      const auto before = sink->traffic().dropped_timeout;
      while (sink->traffic().dropped_timeout < before + 3) ASSERT_TRUE(sink->send(numbered(i, 10)));
    }
  }
}

TEST(Dds, AKilledReaderIsNoticedAndMayComeBack) {
  const auto uri = fresh_topic();
  const auto sink = sink_of(uri + "&readers=1");
  Child child("read", uri);
  ASSERT_TRUE(sink->send(numbered(0, 100'000)));
  child.kill();
  Status sent;
  for (int i = 1; sent; ++i) sent = sink->send(numbered(i, 100'000));
  EXPECT_EQ(sent.error().code, Code::Closed);
  const auto stays = sink_of(uri + "&readers=1&stay=1");
  const auto source = source_of(uri);
  ASSERT_TRUE(stays->send(numbered(7, 1)));
  EXPECT_EQ(next(*source).header.seq, 7);
}

TEST(Dds, AKilledWriterIsTheEnd) {
  const auto uri = fresh_topic();
  const auto source = source_of(uri), stays = source_of(uri + "&reconnect=86400");
  Message message;
  Child child("write", uri + "&readers=2");
  next(*source);
  next(*stays);
  child.kill();
  while (*receive(*source, message)) continue;
  const auto sink = sink_of(uri + "&readers=2");
  ASSERT_TRUE(sink->send(numbered(7, 1)));
  while (next(*stays).elements.size() != 1) continue;
}

TEST(Dds, ASlowReaderThatKeepsTheLatestHoldsUpNobody) {
  constexpr int kCount = 1000;
  const auto uri = fresh_topic();
  const auto slow = source_of(uri + "&keep=latest"), some = source_of(uri + "&keep=1000&memory=1M");
  const auto fast = source_of(uri);
  const auto sink = sink_of(uri + "&readers=3");
  auto sender = send_all(*sink, kCount, 10'000);
  Message message;
  for (int i = 0; i < kCount; ++i) EXPECT_EQ(next(*fast).header.seq, i);
  sender.join();
  EXPECT_EQ(next(*slow).header.seq, kCount - 1);
  EXPECT_FALSE(*receive(*slow, message));
  EXPECT_EQ(slow->traffic().dropped_newer, kCount - 1U);
  while (*receive(*some, message)) continue;
  EXPECT_EQ(some->traffic().messages + some->traffic().dropped_memory, std::uint64_t{kCount});
  EXPECT_LE(some->traffic().messages, 105U);
}

TEST(Dds, OfASlowReaderThatLosesNothingLittleWaits) {
  const auto uri = fresh_topic();
  const auto source = source_of(uri);
  const auto sink = sink_of(uri + "&readers=1&keep=latest");
  int count = 0;
  while (sink->traffic().dropped_newer < 10) ASSERT_TRUE(sink->send(numbered(count++, 100'000)));
  EXPECT_LT(count, 200);  // 2 MiB in the reader's queue, 4 MB in transit
}

TEST(Dds, ARateIsKeptByEitherEnd) {
  const auto uri = fresh_topic();
  const auto source = source_of(uri + "&rate=20&keep=2");
  const auto sink = sink_of(uri + "&readers=1");
  for (int i = 0; i < 10; ++i) ASSERT_TRUE(sink->send(numbered(i, 10)));
  ASSERT_TRUE(sink->close());
  Message message;
  std::uint64_t received = 0;
  while (*receive(*source, message)) ++received;
  EXPECT_EQ(message.header.seq, 0);  // empty after the end
  EXPECT_EQ(received + source->traffic().lost(), 10U);
  EXPECT_GE(source->traffic().delayed, 1U);
}

TEST(Dds, WhatIsNoMessageIsDroppedAndDisturbsNobody) {
  const auto uri = fresh_topic();
  Warnings log;
  const auto source = source_of(uri, log.options());
  const auto sink = sink_of(uri + "&readers=1");
  Stranger text(uri), raw(uri);
  for (int i = 0; i < 20 || log.lines.size() < 2; ++i) {
    text.send("GET / HTTP/1.1\r\n");
    raw.send_raw(std::string("\0\1\0\0\xff\xff\xff\xff----", 12));
    ASSERT_TRUE(sink->send(numbered(i, 10)));
    EXPECT_EQ(next(*source).header.seq, i);
  }
  ASSERT_EQ(log.lines.size(), 2U);
  std::ranges::sort(log.lines);
  const std::string end = "; further ones of this writer are not logged";
  EXPECT_EQ(log.lines[0], uri +
                              ": dropped a sample: Malformed: R5 version: \"GET\" is not an "
                              "integer, at byte 0" +
                              end);
  EXPECT_EQ(log.lines[1], uri +
                              ": dropped a sample: Malformed: not a sequence of octets: length "
                              "4294967295, but 4 bytes" +
                              end);
}

TEST(Dds, OfASampleWhatIsBeforeAFaultIsTaken) {
  const auto uri = fresh_topic();
  Warnings log;
  const auto source = source_of(uri, log.options());
  Stranger stranger(uri);
  stranger.send(encode(numbered(0, 3)) + encode(numbered(1, 3)) + "GET / HTTP/1.1\r\n");
  for (int i = 0; i < 2; ++i) EXPECT_EQ(next(*source).header.seq, i);
  Message message;
  ASSERT_TRUE(source->take(message));
  EXPECT_EQ(log.lines,
            std::vector<std::string>{
                uri + ": dropped the rest of a sample: Malformed: R5 version: \"GET\" is not "
                      "an integer, at byte 60; further ones of this writer are not "
                      "logged"});
}

TEST(Dds, AnOversizedSampleIsDroppedAndDisturbsNobody) {
  const auto uri = fresh_topic();
  Warnings log;
  auto options = log.options();
  options.limits.element_bytes = 1000;
  const auto source = source_of(uri, options);
  const auto sink = sink_of(uri + "&readers=1");
  Stranger stranger(uri);
  for (int i = 0; i < 20 || log.lines.empty(); ++i) {
    stranger.send(encode(numbered(i, 1'000'000)));
    stranger.send(encode(numbered(i, 1001)));
    ASSERT_TRUE(sink->send(numbered(i, 1000)));
    EXPECT_EQ(next(*source).elements.size(), 1000U);
  }
  // A sample far over the limit is not even reassembled.
  EXPECT_EQ(
      log.lines,
      std::vector<std::string>{
          uri + ": dropped a sample: TooLarge: R24 width: 1001 x 1 x 1 bytes exceed the limit "
                "of 1000, at byte 22; further ones of this writer are not logged"});
}

TEST(Dds, WaitingEndsWhenAskedToStop) {
  Stop stop;
  stop.raise();
  const auto sink = sink_of(fresh_topic(), stop.options());
  EXPECT_EQ(sink->send(numbered(0, 1)).error().code, Code::Stopped);
}

TEST(Dds, ItIsInterruptedWhileItWaitsForAReader) {
  Stop stop;
  stop.raise();
  LinkOptions options;
  std::unique_ptr<Sink> sink;
  options.interrupt = {stop.options().stop, [&] {
                         sink->abandon();
                         return true;
                       }};
  std::vector<bool> awaits;
  options.awaits_reader = [&](bool does) { awaits.push_back(does); };
  sink = sink_of(fresh_topic(), options);
  EXPECT_EQ(sink->send(numbered(0, 1)).error().code, Code::Closed);
  EXPECT_EQ(awaits, (std::vector<bool>{true, false}));
}

TEST(Dds, WithNoReadersToWaitForItNeverWaits) {
  const auto sink = sink_of(fresh_topic() + "&readers=0");
  ASSERT_TRUE(sink->send(numbered(1, 1)));
  EXPECT_EQ(sink->traffic().dropped_disconnect, 1U);
  EXPECT_TRUE(sink->close());
}

TEST(Dds, AWriterThatNeverComesIsNotFound) {
  const auto source = source_of(fresh_topic() + "&wait=1");
  Message message;
  EXPECT_EQ(refused(receive(*source, message)).code, Code::NotFound);
}

TEST(Dds, ASourceThatOutlivesItsWritersEndsWhenItIsFinished) {
  const auto uri = fresh_topic();
  const auto source = source_of(uri + "&reconnect=86400");
  Message message;
  for (int i = 0; i < 2; ++i) {
    const auto sink = sink_of(uri + "&readers=1");
    std::thread sender([&] {
      ASSERT_TRUE(sink->send(numbered(i, 1)));
      ASSERT_TRUE(sink->close());
    });
    EXPECT_EQ(next(*source).header.seq, i);
    sender.join();
  }
  source->finish();
  EXPECT_FALSE(*receive(*source, message));
}

TEST(Dds, APlaceIsChecked) {
  const auto wrong = [](const std::string& uri) {
    auto source = open_source(*parse_uri(uri));
    return source ? "" : source.error().text();
  };
  EXPECT_EQ(wrong("dds:1a"),
            "Invalid: \"1a\" is not a DDS topic: use letters, digits, _ and /, not "
            "starting with a digit");
  EXPECT_EQ(wrong("dds:a?domain=233"),
            "Invalid: option domain is a whole number from 0 to 232, not \"233\"");
  EXPECT_EQ(wrong("dds:a?interface=robot"),
            "Invalid: option interface takes IPv4 addresses of this host, separated by commas, "
            "not \"robot\"");
}

TEST(Dds, AnAddressThatThisHostDoesNotHaveIsWaitedFor) {
  const auto uri = *parse_uri("dds:a?interface=192.0.2.77&wait=1");
  Warnings warnings;
  auto source = must(open_source(uri, warnings.options()));
  Message message;
  EXPECT_EQ(must(source->take(message)), Got::Nothing);
  ASSERT_EQ(warnings.lines.size(), 1);
  EXPECT_EQ(warnings.lines.front(), uri.text() +
                                        ": no network interface of this host that is up has the "
                                        "address 192.0.2.77; waiting");
  must(source->wait());  // until `wait` is over, with an attempt each second
  while (true) {
    const auto got = source->take(message);
    if (!got) {
      EXPECT_EQ(got.error().text(),
                "NotFound: no network interface of this host that is up has the address "
                "192.0.2.77");
      break;
    }
    must(source->wait());
  }
  EXPECT_EQ(warnings.lines.size(), 1);
  auto sink = must(open_sink(*parse_uri("dds:a?interface=192.0.2.77&readers=0")));
  ASSERT_TRUE(sink->send(numbered(1, 1)));
  EXPECT_EQ(sink->traffic().dropped_disconnect, 1);
  EXPECT_TRUE(sink->close());
}

}  // namespace

int run(int count, char** words) {
  dds::add_transport();
  if (count == 3 && std::string_view(words[1]) == "read") return Child::read(words[2]), 0;
  if (count == 3 && std::string_view(words[1]) == "write") return Child::write(words[2]), 0;
  ::testing::InitGoogleTest(&count, words);
  return RUN_ALL_TESTS();
}

}  // namespace hc::testing

int main(int count, char** words) {
  return hc::testing::run(count, words);
}
