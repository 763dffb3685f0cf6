// SPDX-License-Identifier: Apache-2.0
// How publishers and readers find each other, and again when one has left.
#include <hc/link/shm/greeting.h>
#include <hc/link/shm/shm_test.h>
#include <hc/link/stream/ends.h>

#include <memory>
#include <thread>

namespace hc::testing {
namespace {

TEST(ShmMeeting, OneWhoComesLaterGetsWhatIsSentFromThenOn) {
  auto name = fresh_name();
  auto sink = sink_of(name);
  auto first = source_of(name);
  ASSERT_TRUE(sink->send(numbered(0, kSmall)));
  auto second = source_of(name);
  ASSERT_TRUE(sink->send(numbered(1, kSmall)));
  EXPECT_EQ(next(*second).header.seq, 1);
  EXPECT_EQ(next(*first).header.seq, 0);
}

TEST(ShmMeeting, WhoDropsWaitsForTheFirstReaderAlone) {
  auto name = fresh_name();
  auto sink = sink_of(name + "?keep=latest&memory=2M");
  std::thread reader([&] {
    auto source = source_of(name);
    next(*source);
  });
  ASSERT_TRUE(sink->send(numbered(0, kLarge)));
  reader.join();
  for (int i = 0; i < 3000; ++i) ASSERT_TRUE(sink->send(numbered(i, kLarge)));
  EXPECT_TRUE(sink->close());
}

TEST(ShmMeeting, NobodyIsWaitedForWhereReadersIsNone) {
  auto name = fresh_name();
  auto sink = sink_of(name + "?readers=0");
  for (int i = 0; i < 3000; ++i) ASSERT_TRUE(sink->send(numbered(i, i % 2 ? kSmall : kLarge)));
  EXPECT_EQ(sink->traffic().dropped_disconnect, 3000U);
  auto source = source_of(name);
  ASSERT_TRUE(sink->send(numbered(3000, kLarge)));
  EXPECT_EQ(next(*source).header.seq, 3000);
  source.reset();
  ASSERT_TRUE(sink->send(numbered(3001, kSmall)));
  EXPECT_TRUE(sink->close());
}

/// What is called while send() waits may abandon the sink.
TEST(ShmMeeting, ASinkThatWaitsCanBeAbandoned) {
  auto name = fresh_name();
  Stop interrupt;
  std::unique_ptr<Sink> sink;
  LinkOptions options;
  options.interrupt = {interrupt.options().stop, [&] {
                         sink->abandon();
                         return true;
                       }};
  interrupt.raise();
  sink = sink_of(name, options);
  EXPECT_EQ(sink->send(numbered(1, kSmall)).error().code, Code::Closed);
  EXPECT_EQ(sink->send(numbered(2, kSmall)).error().code, Code::Closed);
  EXPECT_TRUE(sink_of(name));
}

TEST(ShmMeeting, ANameIsFreeAgainAsSoonAsItsPublisherHasGone) {
  auto name = fresh_name();
  auto sink = sink_of(name);
  const auto taken = refused(open_sink(*parse_uri(name)));
  EXPECT_NE(taken.text().find("in use"), std::string::npos) << taken.text();
  ASSERT_TRUE(sink->close());
  EXPECT_TRUE(open_sink(*parse_uri(name)));
}

TEST(ShmMeeting, AReaderThatReconnectsFindsTheNextPublisher) {
  auto name = fresh_name();
  auto source = source_of(name + "?reconnect=60&keep=all");  // nobody is there yet
  std::thread publisher([&] {
    for (int life = 0; life < 3; ++life) {
      auto sink = sink_of(name + "?readers=1");
      for (int i = 0; i < 10; ++i) ASSERT_TRUE(sink->send(numbered(i, i % 2 ? kSmall : kLarge)));
      if (life % 2 == 0) {
        ASSERT_TRUE(sink->close());
      }
    }
  });
  for (int i = 0; i < 30; ++i) ASSERT_EQ(next(*source).header.seq, i % 10);
  publisher.join();
  EXPECT_EQ(source->traffic().messages, 30U);
  Message message;
  auto impatient = source_of(fresh_name() + "?reconnect=1");
  EXPECT_EQ(receive(*impatient, message).error().code, Code::NotFound);
}

/// Listens at the name as a publisher that is stopped does: nobody answers.
class StoppedPublisher {
 public:
  explicit StoppedPublisher(const std::string& name)
      : listening_(std::move(*internal::listen_unix(internal::meeting_place(*parse_uri(name))))) {}
  /// What the next reader has said, and nothing is answered.
  Descriptor await_reader() {
    pollfd polled{listening_.descriptor.get(), POLLIN, 0};
    EXPECT_EQ(::poll(&polled, 1, -1), 1);
    return Descriptor(::accept4(listening_.descriptor.get(), nullptr, nullptr, SOCK_CLOEXEC));
  }

 private:
  ListeningSocket listening_;
};

TEST(ShmMeeting, AReaderThatReconnectsDoesNotWaitForAPublisherThatIsStopped) {
  auto name = fresh_name();
  auto stopped = std::make_unique<StoppedPublisher>(name);
  Warnings warnings;
  auto source = source_of(name + "?reconnect=60", warnings.options());
  auto reader = stopped->await_reader();
  Message message;
  EXPECT_EQ(*source->take(message), Got::Nothing);
  EXPECT_TRUE(source->prepare_wait());
  // Who waits 4 s for an answer would have given up by itself, and said so.
  EXPECT_TRUE(warnings.lines.empty());
  stopped.reset();
  reader.reset();
  auto sink = sink_of(name);
  EXPECT_EQ(carry(*sink, *source, numbered(1, kSmall)).header.seq, 1);
  const std::string link = name + "?reconnect=60: ";
  EXPECT_EQ(warnings.lines, (std::vector<std::string>{
                                link + "the publisher closed during the handshake; reconnecting",
                                link + "reconnected"}));
}

TEST(ShmMeeting, NobodyThereIsSaid) {
  EXPECT_EQ(refused(open_source(*parse_uri(fresh_name()))).code, Code::Closed);
}

}  // namespace
}  // namespace hc::testing
