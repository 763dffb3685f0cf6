// SPDX-License-Identifier: Apache-2.0
#include <hc/link/shm/greeting.h>
#include <hc/link/socket_test.h>
#include <hc/link/unix.h>
#include <unistd.h>

#include <array>
#include <numeric>
#include <vector>

namespace hc::testing {
namespace {

std::string fresh_name() {
  static int count = 0;
  return "shm:test-" + std::to_string(::getpid()) + "-" + std::to_string(count++);
}

INSTANTIATE_TEST_SUITE_P(Shm, LinkConformance,
                         ::testing::Values(Transport{"shm",
                                                     [] {
                                                       auto name = fresh_name();
                                                       return std::pair(name + "?wait=10",
                                                                        name + "?readers=1");
                                                     },
                                                     true, true, true}),
                         [](const auto& test) { return test.param.name; });

constexpr std::int32_t kSmall = 10, kLarge = 100'000;  // elements [byte]

/// Takes what is there, and gives how many messages it was.
int drain(Source& source, Message& message) {
  int count = 0;
  while (*source.take(message) == Got::Message) ++count;
  return count;
}

TEST(Shm, LargeElementsAreReadWhereTheyWereWritten) {
  auto name = fresh_name();
  auto sink = sink_of(name);
  auto source = source_of(name);
  auto header = numbered(0, kLarge).header;
  Draft draft = sink->loan(header);
  std::iota(draft.view<std::uint8_t>().numbers().begin(),
            draft.view<std::uint8_t>().numbers().end(), std::uint8_t{0});
  const auto* written = draft.elements().data();
  Message sent = std::move(draft).finish();
  ASSERT_TRUE(sink->send(sent));
  ASSERT_TRUE(sink->send(sent));  // once more, without a copy
  Message first, second;
  ASSERT_TRUE(*receive(*source, first));
  ASSERT_TRUE(*receive(*source, second));
  EXPECT_EQ(first.elements.data(), second.elements.data());
  EXPECT_EQ(first.characters(), sent.characters());
  EXPECT_EQ(sent.elements.data(), written);
}

/// Elements of every size about that of a cell, with headers of several lengths; in memory that
/// begins anywhere and ends with them, so that what is read beyond it is noticed (ASan).
TEST(Shm, EverySizeArrivesWhole) {
  auto name = fresh_name();
  auto sink = sink_of(name);
  auto source = source_of(name);
  for (std::size_t shift = 0; shift < 9; ++shift)
    for (std::int32_t size = 0; size <= 260; ++size) {
      std::vector<std::byte> memory(shift + static_cast<std::size_t>(size));
      for (std::size_t i = 0; i < memory.size(); ++i)
        memory[i] = static_cast<std::byte>(i * 37 + 1);
      Message sent;
      sent.header = numbered(size % 3 == 0 ? 1'234'567'890 : size, size).header;
      sent.elements = std::span(memory).subspan(shift);
      ASSERT_TRUE(sink->send(sent));
      Message message;
      ASSERT_TRUE(*receive(*source, message));
      ASSERT_EQ(message.header, sent.header);
      ASSERT_EQ(message.characters(), sent.characters()) << size;
    }
}

TEST(Shm, ASlotIsUsedAgainOnlyWhenNobodyHoldsIt) {
  auto name = fresh_name();
  auto sink = sink_of(name + "?memory=2M");
  auto source = source_of(name);
  ASSERT_TRUE(sink->send(numbered(1, kLarge)));
  Message held, message;
  ASSERT_TRUE(*receive(*source, held));
  for (int i = 2; i < 200; ++i) {
    ASSERT_TRUE(sink->send(numbered(i, kLarge)));
    ASSERT_TRUE(*receive(*source, message));
    EXPECT_NE(message.elements.data(), held.elements.data());
    EXPECT_EQ(message.characters(), numbered(i, kLarge).characters());
  }
  EXPECT_EQ(held.characters(), numbered(1, kLarge).characters());
  source.reset();
  EXPECT_EQ(held.characters(), numbered(1, kLarge).characters());
}

TEST(Shm, WhoKeepsTheLatestGetsItAndLosesTheOthers) {
  for (auto size : {kSmall, kLarge}) {
    auto name = fresh_name();
    auto sink = sink_of(name + "?memory=2M");
    auto source = source_of(name + "?keep=latest");
    constexpr int kCount = 5000;  // more than there are cells, more than fit into the memory
    for (int i = 0; i < kCount; ++i) ASSERT_TRUE(sink->send(numbered(i, size)));
    Message message;
    ASSERT_EQ(drain(*source, message), 1);
    ASSERT_TRUE(sink->send(numbered(kCount, size)));
    ASSERT_TRUE(*receive(*source, message));
    EXPECT_EQ(message.characters(), numbered(kCount, size).characters());
    EXPECT_EQ(source->traffic().superseded, static_cast<std::uint64_t>(kCount) - 1);
    EXPECT_EQ(source->traffic().messages, 2U);
  }
}

TEST(Shm, WhoKeepsMoreThanFitsLosesTheOldest) {
  auto name = fresh_name();
  auto sink = sink_of(name + "?memory=2M&keep=30");
  auto source = source_of(name);
  for (int i = 0; i < 100; ++i) ASSERT_TRUE(sink->send(numbered(i, kLarge)));
  std::vector<std::int64_t> seen;
  Message message;
  while (*source->take(message) == Got::Message) seen.push_back(message.header.seq);
  ASSERT_FALSE(seen.empty());
  EXPECT_EQ(seen.back(), 99);
  for (std::size_t i = 1; i < seen.size(); ++i) EXPECT_EQ(seen[i], seen[i - 1] + 1);
  EXPECT_EQ(source->traffic().superseded, 70U);
  EXPECT_EQ(seen.size() + source->traffic().over_memory, 30U);
  EXPECT_GT(source->traffic().over_memory, 0U);  // fewer fit
}

TEST(Shm, ASlowReaderDoesNotHoldUpAnother) {
  auto name = fresh_name();
  auto sink = sink_of(name + "?readers=2&memory=2M");
  auto slow = source_of(name + "?keep=latest");
  auto quick = source_of(name);
  Message message;
  for (int i = 0; i < 3000; ++i) {
    ASSERT_TRUE(sink->send(numbered(i, i % 2 == 0 ? kSmall : kLarge)));
    ASSERT_TRUE(*receive(*quick, message));
    ASSERT_EQ(message.header.seq, i);
  }
  EXPECT_EQ(drain(*slow, message), 1);
  EXPECT_EQ(slow->traffic().superseded, 2999U);
}

TEST(Shm, AReaderThatHoldsTooManyIsToldAndGetsCopies) {
  auto name = fresh_name();
  auto sink = sink_of(name);
  int told = 0;
  LinkOptions options;
  options.log = [&](Severity, std::string_view line) {
    EXPECT_NE(line.find("are held"), std::string_view::npos) << line;
    ++told;
  };
  auto source = source_of(name, options);
  std::vector<Message> held(100);
  for (int i = 0; i < 100; ++i) {
    ASSERT_TRUE(sink->send(numbered(i, kLarge)));
    ASSERT_TRUE(*receive(*source, held[static_cast<std::size_t>(i)]));
  }
  EXPECT_EQ(told, 1);
  for (int i = 0; i < 100; ++i)
    EXPECT_EQ(held[static_cast<std::size_t>(i)].characters(), numbered(i, kLarge).characters());
}

TEST(Shm, AReaderThatHoldsAllDoesNotStallAPublisherThatDrops) {
  auto name = fresh_name();
  auto sink = sink_of(name + "?keep=latest&memory=2M");
  auto source = source_of(name);
  std::vector<Message> held(100);
  int count = 0;
  for (int i = 0; i < 100; ++i) {
    ASSERT_TRUE(sink->send(numbered(i, kLarge)));
    if (*source->take(held[static_cast<std::size_t>(i)]) == Got::Message) ++count;
  }
  EXPECT_LT(count, 100);
  EXPECT_EQ(sink->traffic().messages, 100U);
  EXPECT_EQ(sink->traffic().over_memory + static_cast<std::uint64_t>(count), 100U);
}

TEST(Shm, APublisherWaitsForRoomUntilItIsLetGo) {
  auto name = fresh_name();
  auto sink = sink_of(name + "?memory=2M");
  auto source = source_of(name);
  std::vector<Message> held;
  std::thread publisher([&] {
    for (int i = 0; i < 100; ++i) ASSERT_TRUE(sink->send(numbered(i, kLarge)));
    ASSERT_TRUE(sink->close());
  });
  Message message;
  for (int i = 0; i < 100; ++i) {
    ASSERT_TRUE(*receive(*source, message)) << i;
    ASSERT_EQ(message.header.seq, i);
    held.push_back(message);
    if (held.size() == 7) held.clear();
  }
  publisher.join();
}

TEST(Shm, APublisherThatWaitsCanBeStopped) {
  auto name = fresh_name();
  Stop stop;
  auto sink = sink_of(name, stop.options());
  auto source = source_of(name);
  std::thread publisher([&] {
    Status sent;
    for (int i = 0; sent; ++i) sent = sink->send(numbered(i, kSmall));
    EXPECT_EQ(sent.error().code, Code::Stopped);
  });
  Message message;
  ASSERT_TRUE(*receive(*source, message));
  stop.raise();
  publisher.join();
}

TEST(Shm, AReaderThatWaitsCanBeStopped) {
  for (const char* spin : {"0", "1000000"}) {
    auto name = fresh_name();
    Stop stop;
    auto sink = sink_of(name);
    auto source = source_of(name + "?spin=" + spin);
    std::thread reader([&] {
      Message message;
      auto got = receive(*source, message, stop.options().stop);
      ASSERT_FALSE(got);
      EXPECT_EQ(got.error().code, Code::Stopped);
    });
    stop.raise();
    reader.join();
  }
}

TEST(Shm, SeveralSourcesAreWaitedForTogether) {
  auto first_name = fresh_name(), second_name = fresh_name();
  auto first_sink = sink_of(first_name), second_sink = sink_of(second_name);
  auto first = source_of(first_name), second = source_of(second_name);
  constexpr int kCount = 2000;
  std::thread publisher([&] {
    for (int i = 0; i < kCount; ++i)
      ASSERT_TRUE((i % 3 == 0 ? first_sink : second_sink)->send(numbered(i, kSmall)));
    ASSERT_TRUE(first_sink->close());
    ASSERT_TRUE(second_sink->close());
  });
  const std::array<Source*, 2> both = {first.get(), second.get()};
  Message message;
  int count = 0, ends = 0;
  while (ends < 2) {
    ends = 0;
    bool any = false;
    for (Source* source : both) {
      auto got = source->take(message);
      ASSERT_TRUE(got);
      if (*got == Got::Message) ++count;
      if (*got == Got::End) ++ends;
      any = any || *got == Got::Message;
    }
    if (!any && ends < 2) {
      ASSERT_TRUE(*wait_any(both));
    }
  }
  EXPECT_EQ(count, kCount);
  publisher.join();
}

TEST(Shm, OneWhoComesLaterHearsWhatIsSentFromThenOn) {
  auto name = fresh_name();
  auto sink = sink_of(name);
  auto first = source_of(name);
  ASSERT_TRUE(sink->send(numbered(0, kSmall)));
  auto second = source_of(name);
  ASSERT_TRUE(sink->send(numbered(1, kSmall)));
  Message message;
  ASSERT_TRUE(*receive(*second, message));
  EXPECT_EQ(message.header.seq, 1);
  ASSERT_TRUE(*receive(*first, message));
  EXPECT_EQ(message.header.seq, 0);
}

TEST(Shm, WhoDropsWaitsForTheFirstReaderAlone) {
  auto name = fresh_name();
  auto sink = sink_of(name + "?keep=latest&memory=2M");
  std::thread reader([&] {
    auto source = source_of(name);
    Message message;
    EXPECT_TRUE(*receive(*source, message));
  });
  ASSERT_TRUE(sink->send(numbered(0, kLarge)));
  reader.join();
  for (int i = 0; i < 3000; ++i) ASSERT_TRUE(sink->send(numbered(i, kLarge)));
  EXPECT_TRUE(sink->close());
}

TEST(Shm, ANameIsFreeAgainAsSoonAsItsPublisherHasGone) {
  auto name = fresh_name();
  auto sink = sink_of(name);
  auto taken = open_sink(*parse_uri(name));
  ASSERT_FALSE(taken);
  EXPECT_NE(taken.error().text().find("in use"), std::string::npos) << taken.error().text();
  ASSERT_TRUE(sink->close());
  EXPECT_TRUE(open_sink(*parse_uri(name)));
}

TEST(Shm, AReaderThatReconnectsFindsTheNextPublisher) {
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
  Message message;
  for (int i = 0; i < 30; ++i) {
    ASSERT_TRUE(*receive(*source, message));
    ASSERT_EQ(message.header.seq, i % 10);
  }
  publisher.join();
  EXPECT_EQ(source->traffic().messages, 30U);
  auto impatient = source_of(fresh_name() + "?reconnect=1");
  EXPECT_EQ(receive(*impatient, message).error().code, Code::NotFound);
}

/// Listens at the name as a publisher that is stopped does: nobody answers.
class StoppedPublisher {
 public:
  explicit StoppedPublisher(const std::string& name)
      : listening_(std::move(*internal::listen_unix(internal::meeting_place(*parse_uri(name))))) {}
  /// What the next reader has said, and nothing is answered.
  internal::Descriptor await_reader() {
    pollfd polled{listening_.descriptor.get(), POLLIN, 0};
    EXPECT_EQ(::poll(&polled, 1, -1), 1);
    return internal::Descriptor(
        ::accept4(listening_.descriptor.get(), nullptr, nullptr, SOCK_CLOEXEC));
  }

 private:
  internal::ListeningSocket listening_;
};

TEST(Shm, AReaderThatReconnectsDoesNotWaitForAPublisherThatIsStopped) {
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
  std::thread publisher([&] { ASSERT_TRUE(sink->send(numbered(1, kSmall))); });
  ASSERT_TRUE(*receive(*source, message));
  EXPECT_EQ(message.header.seq, 1);
  publisher.join();
  ASSERT_EQ(warnings.lines.size(), 1U);
  EXPECT_EQ(warnings.lines[0], name +
                                   "?reconnect=60: the publisher has gone before it answered; "
                                   "connecting again");
}

TEST(Shm, NobodyThereIsSaid) {
  auto source = open_source(*parse_uri(fresh_name()));
  ASSERT_FALSE(source);
  EXPECT_EQ(source.error().code, Code::Closed);
}

TEST(Shm, AMessageThatDoesNotFitIsRefused) {
  auto name = fresh_name();
  auto sink = sink_of(name + "?memory=2M");
  auto source = source_of(name);
  auto sent = sink->send(numbered(0, 3'000'000));
  ASSERT_FALSE(sent);
  EXPECT_EQ(sent.error().code, Code::TooLarge);
  Message message;
  ASSERT_TRUE(sink->send(numbered(1, kLarge)));
  EXPECT_TRUE(*receive(*source, message));
}

TEST(Shm, AProgramThatKeepsAllLoansIsToldSo) {
  auto name = fresh_name();
  auto sink = sink_of(name + "?memory=2M");
  auto source = source_of(name);
  std::vector<Draft> loans;
  for (int i = 0; i < 30; ++i) loans.push_back(sink->loan(numbered(i, kLarge).header));
  auto sent = sink->send(numbered(0, kLarge));
  ASSERT_FALSE(sent);
  EXPECT_EQ(sent.error().text(), "TooLarge: no room left: this program holds all of the memory");
}

TEST(Shm, TextTravelsWithItsHeaderAndWithoutBeingWritten) {
  auto name = fresh_name();
  auto sink = sink_of(name);
  auto source = source_of(name);
  Header header;
  header.info = {MatrixType::Position, 3, Scalar::F64, Encoding::Text};
  header.width = header.height = 1;
  Draft draft = sink->loan(header);
  draft.view<double>().at(0, 0, 1) = 0.1;
  ASSERT_TRUE(sink->send(std::move(draft).finish()));
  Message message;
  ASSERT_TRUE(*receive(*source, message));
  EXPECT_EQ(message.header.info, header.info);
  EXPECT_EQ(message.view<double>()->at(0, 0, 1), 0.1);
}

}  // namespace
}  // namespace hc::testing
