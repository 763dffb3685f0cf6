// SPDX-License-Identifier: Apache-2.0
// Memory whose words its owner writes against the rules, before they are read and while they are
// checked: an error or nothing, no crash and no hang. In full, best with AddressSanitizer:
//
//     HC_SHM_ROUNDS=100000000 build/asan/tests/shm/shm_hostile_memory
#include <algorithm>
#include <atomic>
#include <iostream>

#include "checked_message.h"
#include "hostile_peer.h"

namespace hc::testing {
namespace {

using internal::Cell;
using internal::kCells;
using internal::kLeastMemory;
using internal::kSlotsBegin;

constexpr std::uint64_t kMost = std::numeric_limits<std::uint64_t>::max();

std::string line_of(std::int32_t bytes) {
  Header header;
  header.info = {MatrixType::IntensityImage, 1, Scalar::U8, Encoding::Binary};
  header.width = bytes;
  header.height = 1;
  return text(header) + "\n";
}

std::uint64_t sizes_of(std::uint64_t bytes, std::size_t line_bytes) {
  return bytes << 16 | line_bytes;
}

void write_cell(Cell& cell, std::uint64_t slot, std::uint64_t sizes, const std::string& line) {
  std::array<std::uint64_t, Cell::kWords> words{};
  std::memcpy(words.data(), line.data(), std::min(line.size(), Cell::kTextBytes));
  cell.slot.store(slot, std::memory_order_relaxed);
  cell.sizes.store(sizes, std::memory_order_relaxed);
  for (std::size_t i = 0; i < words.size(); ++i)
    cell.text[i].store(words[i], std::memory_order_relaxed);
}

/// A publisher whose memory is all right at first, and a reader of it.
class HostileMemory : public ::testing::Test {
 protected:
  void open(const std::string& options = "", std::uint64_t begin = 0, std::uint64_t keep = 0) {
    source_.reset();
    publisher_.reset();
    auto name = fresh_name();
    memory_ = std::make_unique<Writable>(kLeastMemory);
    publisher_ = std::make_unique<FakePublisher>(name);
    auto source =
        publisher_->open(name + options, offer(kLeastMemory, begin, keep), {memory_->descriptor()});
    ASSERT_TRUE(source) << source.error().text();
    source_ = std::move(*source);
  }

  /// Publishes one cell; what take() says of it.
  std::string say_of(std::uint64_t slot, std::uint64_t sizes, const std::string& line,
                     std::uint64_t stamp = 1) {
    open();
    write_cell(memory_->cell(0), slot, sizes, line);
    memory_->head().published.store(1);
    memory_->cell(0).stamp.store(stamp);
    auto got = source_->take(message_);
    return got ? *got == Got::Message ? "message" : "nothing" : got.error().text();
  }

  std::unique_ptr<Writable> memory_;
  std::unique_ptr<FakePublisher> publisher_;
  std::unique_ptr<Source> source_;
  Message message_;
};

#define EXPECT_SAYS(text, said) EXPECT_NE((said).find(text), std::string::npos) << (said)

TEST_F(HostileMemory, ACellSaysWhatCannotBe) {
  const std::string damaged = "Malformed: the publisher's memory is damaged: ";
  const std::string line = line_of(100), large = line_of(100'000);
  const auto fits = sizes_of(100, line.size()), in_slot = sizes_of(100'000, large.size());
  EXPECT_EQ(say_of(0, fits, line), "message");
  EXPECT_EQ(say_of(kSlotsBegin, in_slot, large), "message");
  for (auto sizes : {sizes_of(100, 0xffff), sizes_of(0xffff'ffff'ffff, line.size()), kMost,
                     sizes_of(Cell::kTextBytes, 1), sizes_of(0, Cell::kTextBytes + 1)})
    EXPECT_EQ(say_of(0, sizes, line), damaged + "invalid sizes of a cell");
  EXPECT_EQ(say_of(kSlotsBegin, sizes_of(100'000, 233), large),
            damaged + "invalid sizes of a cell");
  for (auto sizes : {sizes_of(100, line.size() - 1), sizes_of(100, line.size() + 1),
                     sizes_of(100, 0), std::uint64_t{0}})
    EXPECT_SAYS("a header without a line feed", say_of(0, sizes, line));
  for (auto bytes : {0, 99, 101})
    EXPECT_SAYS(" bytes of elements for ",
                say_of(0, sizes_of(static_cast<std::uint64_t>(bytes), line.size()), line));
  for (auto slot : {std::uint64_t{1}, kSlotsBegin - 64, kSlotsBegin + 1, kSlotsBegin + 63,
                    kLeastMemory - 64, kLeastMemory, kMost - 63, kMost})
    EXPECT_EQ(say_of(slot, in_slot, large), damaged + "invalid offset of a slot") << slot;
  for (const char* bad : {"hello world\n", "\n", "1 1 1\n", " \n"})
    EXPECT_SAYS("Malformed: ", say_of(0, sizes_of(0, std::strlen(bad)), bad));
  auto huge = line_of(std::numeric_limits<std::int32_t>::max());
  EXPECT_SAYS("TooLarge: ", say_of(kSlotsBegin, sizes_of(0x7fff'ffff, huge.size()), huge));
  EXPECT_EQ(say_of(0, fits, line, 2), damaged + "invalid stamp of a cell");
  EXPECT_EQ(say_of(0, fits, line, kMost), damaged + "invalid stamp of a cell");
  EXPECT_EQ(say_of(0, fits, line, 0), "nothing");
}

TEST_F(HostileMemory, PositionsMakeNoSense) {
  struct Words {
    std::uint64_t published, oldest, stamp;
  };
  for (const char* options : {"", "?keep=latest", "?keep=4294967296"})
    for (auto begin : {std::uint64_t{0}, std::uint64_t{1000}, kMost - 1, kMost})
      for (auto keep : {std::uint64_t{0}, std::uint64_t{1}, kMost})
        for (auto words : {Words{kMost, 0, 0}, Words{kMost, kMost, kMost}, Words{5, kMost, 9},
                           Words{0, 5, 9}, Words{kMost - 1, kMost - 2, kMost - 1}}) {
          open(options, begin, keep);
          auto& head = memory_->head();
          head.published.store(words.published);
          head.oldest.store(words.oldest);
          head.wanted.store(words.published);
          for (std::uint64_t i = 0; i < kCells; ++i) memory_->cell(i).stamp.store(words.stamp);
          for (int i = 0; i < 10; ++i)
            if (!source_->take(message_)) break;
        }
}

/// Whatever it has announced, nothing comes from a publisher that has gone.
TEST_F(HostileMemory, APublisherThatHasGoneIsTheEnd) {
  for (const char* options : {"", "?keep=latest"})
    for (auto closed : {0, 1}) {
      open(options);
      memory_->head().published.store(5);
      memory_->head().closed.store(static_cast<std::uint32_t>(closed));
      EXPECT_EQ(*source_->take(message_), Got::Nothing);
      publisher_->leave_reader();
      auto got = receive(*source_, message_);
      if (closed == 1) {
        ASSERT_TRUE(got) << got.error().text();
        EXPECT_FALSE(*got);
      } else {
        ASSERT_FALSE(got);
        EXPECT_EQ(got.error().text(), "Closed: the publisher has died");
      }
    }
}

TEST_F(HostileMemory, AReaderThatCountsOnAHugeNumberLosesNothing) {
  auto name = fresh_name();
  auto sink = std::move(*open_sink(*parse_uri(name)));
  source_ = std::move(*open_source(*parse_uri(name + "?keep=4294967296")));
  for (int i = 0; i < 10; ++i) ASSERT_TRUE(sink->send(make_checked(nullptr, 1, i, 24)));
  for (int i = 0; i < 10; ++i) {
    ASSERT_EQ(*source_->take(message_), Got::Message);
    EXPECT_EQ(message_.header.seq, i);
  }
}

/// Writes right cells where the reader is, and over them words that are not right, at any moment.
class Disturber {
 public:
  Disturber(const Writable& memory, const internal::ReaderPage& reader, bool latest)
      : memory_(memory), reader_(reader), latest_(latest) {}

  void run(const std::atomic<bool>& done) {
    constexpr std::uint64_t kRun = 64;
    auto& head = memory_.head();
    while (!done.load(std::memory_order_relaxed)) {
      // A reader says how far it is when it has taken something, not when it leaves something out.
      auto begin = std::max(reader_.cursor.load(), head.oldest.load());
      if (latest_) begin = std::max(begin, head.published.load());
      for (auto position = begin; position < begin + kRun; ++position) {
        fill(memory_.cell(position));
        memory_.cell(position).stamp.store(position + 1, std::memory_order_release);
        if (latest_ || dice_() % 2 == 0) disturb(std::max(position, begin + 1) - 1);
      }
      head.published.store(begin + dice_() % kRun, std::memory_order_relaxed);
      for (std::uint64_t i = 0; i < kRun; ++i) disturb(begin + dice_() % kRun);
    }
  }

 private:
  void fill(Cell& cell) {
    if (dice_() % 2 == 0)
      write_cell(cell, 0, sizes_[0], small_);
    else
      write_cell(cell, slots_[dice_() % 3], sizes_[1], large_);
  }
  void disturb(std::uint64_t position) {
    Cell& cell = memory_.cell(position);
    auto& head = memory_.head();
    auto number = dice_();
    switch (dice_() % 16) {
      case 0:
        cell.sizes.store(sizes_[number % sizes_.size()], std::memory_order_relaxed);
        break;
      case 1:
        cell.slot.store(slots_[number % slots_.size()], std::memory_order_relaxed);
        break;
      case 2:
        cell.text[number % Cell::kWords].store(dice_(), std::memory_order_relaxed);
        break;
      case 3:
        cell.text[number % 8].fetch_xor(std::uint64_t{1} << (number / 8 % 64),
                                        std::memory_order_relaxed);
        break;
      case 4:
        if (number % 16 == 0) cell.stamp.store(number, std::memory_order_relaxed);
        break;
      case 5:
        if (number % 16 == 0) head.oldest.store(position, std::memory_order_relaxed);
        break;
      case 6:
        head.wanted.store(number % 4, std::memory_order_relaxed);
        break;
      default:
        break;
    }
  }

  const std::string small_ = line_of(100), large_ = line_of(100'000);
  const std::array<std::uint64_t, 8> sizes_ = {sizes_of(100, small_.size()),
                                               sizes_of(100'000, large_.size()),
                                               0,
                                               kMost,
                                               sizes_of(1 << 30, large_.size()),
                                               sizes_of(Cell::kTextBytes, Cell::kTextBytes),
                                               sizes_of(0, Cell::kTextBytes),
                                               sizes_of(Cell::kTextBytes - 60, small_.size())};
  const std::array<std::uint64_t, 7> slots_ = {
      0, kSlotsBegin, kSlotsBegin + 64, kLeastMemory - 64, kLeastMemory, 8, kMost - 63};
  const Writable& memory_;
  const internal::ReaderPage& reader_;
  bool latest_;
  Dice dice_;
};

TEST_F(HostileMemory, WordsChangeWhileTheyAreChecked) {
  for (bool latest : {false, true}) {
    open("", 0, latest ? 1 : 0);
    std::atomic<bool> done{false};
    Disturber disturber(*memory_, publisher_->page(), latest);
    std::thread writer([&] { disturber.run(done); });
    std::int64_t messages = 0, errors = 0, idle = 0;
    std::uint64_t sum = 0, cursor = 0;
    while (messages + errors < rounds(300'000) / 2) {
      auto got = source_->take(message_);
      if (publisher_->page().cursor.load(std::memory_order_relaxed) == cursor) {
        if (++idle % 64 == 0) std::this_thread::yield();
        continue;  // no cell was checked
      }
      cursor = publisher_->page().cursor.load(std::memory_order_relaxed);
      if (!got) {
        ++errors;
        continue;
      }
      ++messages;
      EXPECT_EQ(message_.elements.size(), message_.header.element_bytes());
      for (std::size_t at = 0; at < message_.elements.size(); at += kPageBytes)
        sum += std::to_integer<std::uint64_t>(message_.elements[at]);
      if (!message_.elements.empty())
        sum += std::to_integer<std::uint64_t>(message_.elements.back());
    }
    done = true;
    writer.join();
    std::cout << (latest ? "keep=latest" : "keep=all") << ": " << messages << " messages, "
              << errors << " errors, sum " << sum << "\n";
    EXPECT_GT(messages, 0);
    EXPECT_GT(errors, 0);
  }
}

}  // namespace
}  // namespace hc::testing
