// SPDX-License-Identifier: Apache-2.0
// Readers of shared memory that lag behind, hold much, come and go, beside others that do not.
#include <hc/link/shm/shm_test.h>

#include <atomic>
#include <random>
#include <vector>

#include <hc/link/shm/layout.h>
#include <hc/testing/must.h>

namespace hc::testing {
namespace {

class ShmSlow : public ShmLink {};

TEST_F(ShmSlow, APublisherTakesMemoryFromWhoLosesMessagesWhileItWaitsForOthers) {
  auto name = fresh_name();
  auto sink = sink_of(name + "?readers=2&memory=2M");
  auto reader = source_of(name);
  auto lagging = source_of(name + "?keep=1000");  // more than fit into the memory
  constexpr int kCount = 100;
  auto publisher = send_all(*sink, kCount, kLarge);
  for (int i = 0; i < kCount; ++i) ASSERT_EQ(next(*reader).header.seq, i);
  publisher.join();
  Message message;
  while (*lagging->take(message) == Got::Message) {
  }
  EXPECT_EQ(message.header.seq, kCount - 1);
  EXPECT_EQ(lagging->traffic().messages + lagging->traffic().dropped_memory, std::uint64_t{kCount});
}

/// A cell that is written again while it is read is no damage.
TEST_F(ShmSlow, WhoIsOvertakenWhileItReadsGoesOn) {
  open("?keep=latest&readers=1", "?keep=" + std::to_string(internal::kCells));
  std::atomic<bool> done{false};
  std::thread publisher([&] {
    Message small = numbered(1, kSmall);
    Message large = sink_->loan(numbered(2, kLarge).header).finish();  // sent without a copy
    // No cell gets the same kind twice in a row.
    for (int i = 0; i < 2'000'000; ++i) ASSERT_TRUE(sink_->send(i % 3 == 0 ? small : large));
    done = true;
  });
  Message message;
  while (!done) {
    auto got = must(source_->take(message));
    if (got == Got::Message) {
      ASSERT_EQ(message.elements.size(), message.header.element_bytes());
    }
  }
  publisher.join();
}

/// A slot is not written again while somebody reads it, however late he came to hold it.
TEST_F(ShmSlow, WhatIsTakenBackJustThenIsWholeOrLost) {
  constexpr std::int32_t kBytes = 4096;
  open("?keep=latest&readers=1&memory=2M", "?keep=" + std::to_string(internal::kCells));
  std::atomic<bool> done{false};
  std::thread publisher([&] {
    for (int i = 0; i < 1'000'000; ++i) ASSERT_TRUE(sink_->send(numbered(i, kBytes)));
    done = true;
  });
  Message message;
  std::uint64_t wrong = 0;
  while (!done) {
    auto got = must(source_->take(message));
    if (got != Got::Message) continue;
    auto right = static_cast<std::byte>(message.header.seq * 7 + kBytes);
    for (std::size_t at = 0; at < message.elements.size(); at += 64)
      if (message.elements[at] != right) ++wrong;
  }
  publisher.join();
  EXPECT_EQ(wrong, 0U);
}

/// Those it waits for leave while it looks for room, with messages that they hold.
TEST_F(ShmSlow, ReadersComeAndGoWhileThePublisherWaits) {
  auto name = fresh_name();
  auto sink = sink_of(name + "?memory=2M");
  std::atomic<bool> done{false};
  std::vector<std::thread> readers;
  for (unsigned seed = 0; seed < 3; ++seed)
    readers.emplace_back([&, seed] {
      std::mt19937 random(seed);
      while (!done) {
        auto source = open_source(*parse_uri(name));
        if (!source) continue;  // just when the publisher ends
        std::vector<Message> held(random() % 18);
        for (auto& message : held) ASSERT_TRUE((*source)->take(message));
        if (random() % 2 == 0) source->reset();
      }
    });
  Message message = numbered(0, kLarge);
  for (int i = 0; i < 3000; ++i) ASSERT_TRUE(sink->send(message)) << i;
  done = true;
  for (auto& reader : readers) reader.join();
}

}  // namespace
}  // namespace hc::testing
