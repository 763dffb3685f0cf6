// SPDX-License-Identifier: Apache-2.0
// That messages arrive, of any size and in place, and that who waits can be stopped.
#include <hc/link/shm/shm_test.h>
#include <hc/link/wait_set.h>

#include <array>
#include <numeric>
#include <thread>
#include <vector>

namespace hc::testing {
namespace {

class Shm : public ShmLink {};

INSTANTIATE_TEST_SUITE_P(Shm, LinkConformance,
                         ::testing::Values(Transport{"shm",
                                                     [] {
                                                       auto name = fresh_name();
                                                       return std::pair(name + "?wait=10",
                                                                        name + "?readers=1");
                                                     },
                                                     true, true, true}),
                         [](const auto& test) { return test.param.name; });

TEST_F(Shm, EachReaderHasARateOfItsOwn) {
  auto name = fresh_name();
  auto sink = sink_of(name + "?readers=2");
  auto slow = source_of(name + "?rate=1&keep=latest"), fast = source_of(name);
  Message message;
  auto send = [&](int seq) {
    ASSERT_TRUE(sink->send(numbered(seq, 10)));
    EXPECT_EQ(next(*fast).header.seq, seq);
  };
  send(0);
  EXPECT_EQ(next(*slow).header.seq, 0);
  for (int i = 1; i < 4; ++i) send(i);
  EXPECT_EQ(*slow->take(message), Got::Nothing);
  EXPECT_TRUE(message.elements.empty());
  EXPECT_EQ(next(*slow).header.seq, 3);
  EXPECT_EQ(slow->traffic().messages, 2U);
  EXPECT_EQ(slow->traffic().throttled, 2U);
  EXPECT_EQ(slow->traffic().delayed, 1U);
  EXPECT_EQ(fast->traffic().lost() + fast->traffic().delayed, 0U);
  ASSERT_TRUE(sink->close());
  EXPECT_FALSE(*receive(*slow, message));
}

TEST_F(Shm, LargeElementsAreReadWhereTheyWereWritten) {
  open();
  auto header = numbered(0, kLarge).header;
  Draft draft = sink_->loan(header);
  std::iota(draft.view<std::uint8_t>().numbers().begin(),
            draft.view<std::uint8_t>().numbers().end(), std::uint8_t{0});
  const auto* written = draft.elements().data();
  Message sent = std::move(draft).finish();
  ASSERT_TRUE(sink_->send(sent));
  ASSERT_TRUE(sink_->send(sent));  // once more, without a copy
  const Message first = next(*source_);
  EXPECT_EQ(first.elements.data(), next(*source_).elements.data());
  EXPECT_EQ(first.text(), sent.text());
  EXPECT_EQ(sent.elements.data(), written);
}

/// Elements of every size about that of a cell, with headers of several lengths; in memory that
/// begins anywhere and ends with them, so that what is read beyond it is noticed (ASan).
TEST_F(Shm, EverySizeArrivesWhole) {
  open();
  for (std::size_t shift = 0; shift < 9; ++shift)
    for (std::int32_t size = 0; size <= 260; ++size) {
      std::vector<std::byte> memory(shift + static_cast<std::size_t>(size));
      for (std::size_t i = 0; i < memory.size(); ++i)
        memory[i] = static_cast<std::byte>(i * 37 + 1);
      Message sent;
      sent.header = numbered(size % 3 == 0 ? 1'234'567'890 : size, size).header;
      sent.elements = std::span(memory).subspan(shift);
      ASSERT_TRUE(sink_->send(sent));
      const Message message = next(*source_);
      ASSERT_EQ(message.header, sent.header);
      ASSERT_EQ(message.text(), sent.text()) << size;
    }
}

TEST_F(Shm, TextTravelsWithItsHeaderAndWithoutBeingWritten) {
  open();
  Header header;
  header.info = {MatrixType::Position, 3, Scalar::F64, Encoding::Text};
  header.width = header.height = 1;
  Draft draft = sink_->loan(header);
  draft.view<double>().at(0, 0, 1) = 0.1;
  ASSERT_TRUE(sink_->send(std::move(draft).finish()));
  const Message message = next(*source_);
  EXPECT_EQ(message.header.info, header.info);
  EXPECT_EQ(message.view<double>()->at(0, 0, 1), 0.1);
}

TEST_F(Shm, AMessageThatDoesNotFitIsRefused) {
  open("?memory=2M");
  EXPECT_EQ(refused(sink_->send(numbered(0, 3'000'000))).code, Code::TooLarge);
  ASSERT_TRUE(sink_->send(numbered(1, kLarge)));
  next(*source_);
}

TEST_F(Shm, SeveralSourcesAreWaitedForTogether) {
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
  WaitSet waits;
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
      ASSERT_TRUE(*waits.wait(both));
    }
  }
  EXPECT_EQ(count, kCount);
  publisher.join();
}

TEST_F(Shm, APublisherThatWaitsCanBeStopped) {
  auto name = fresh_name();
  Stop stop;
  auto sink = sink_of(name, stop.options());
  auto source = source_of(name);
  std::thread publisher([&] {
    Status sent;
    for (int i = 0; sent; ++i) sent = sink->send(numbered(i, kSmall));
    EXPECT_EQ(sent.error().code, Code::Stopped);
  });
  next(*source);
  stop.raise();
  publisher.join();
}

TEST_F(Shm, AReaderThatWaitsCanBeStopped) {
  for (const char* spin : {"0", "1000000"}) {
    auto name = fresh_name();
    Stop stop;
    auto sink = sink_of(name);
    auto source = source_of(name + "?spin=" + spin);
    std::thread reader([&] {
      Message message;
      EXPECT_EQ(refused(receive(*source, message, stop.options().stop)).code, Code::Stopped);
    });
    stop.raise();
    reader.join();
  }
}

}  // namespace
}  // namespace hc::testing
