// SPDX-License-Identifier: Apache-2.0
#include <hc/link/shm/slots.h>

#include <gtest/gtest.h>

#include <iterator>
#include <map>
#include <random>

#include <hc/link/shm/layout.h>

namespace hc::internal {
namespace {

constexpr std::uint64_t kBegin = 4096, kEnd = kBegin + (1 << 20);

void give_back(SlotPool& pool, std::uint64_t begin) {
  pool.sweep([&](const Slot& slot) { return slot.begin == begin; });
}

TEST(SlotPool, GivesTheWarmestThatFits) {
  SlotPool pool(kBegin, kEnd);
  auto first = pool.allocate(1000)->begin, second = pool.allocate(1000)->begin;
  auto large = pool.allocate(5000)->begin;
  EXPECT_EQ(pool.reuse(1000), nullptr);
  give_back(pool, second);
  give_back(pool, first);
  give_back(pool, large);
  EXPECT_EQ(pool.find(first), nullptr);
  EXPECT_EQ(pool.reuse(990)->begin, first);
  EXPECT_EQ(pool.reuse(990)->begin, second);
  EXPECT_EQ(pool.reuse(990), nullptr);  // the large one is for large messages
  EXPECT_EQ(pool.reuse(2600)->begin, large);
  EXPECT_EQ(pool.find(large)->bytes, 5056U);
}

TEST(SlotPool, NothingTakesALine) {
  SlotPool pool(kBegin, kBegin + 2 * kLine);
  EXPECT_EQ(pool.allocate(0)->bytes, kLine);
  EXPECT_EQ(pool.allocate(1)->begin, kBegin + kLine);
  EXPECT_EQ(pool.allocate(0), nullptr);
}

TEST(SlotPool, WhoIsReferredToStays) {
  SlotPool pool(kBegin, kEnd);
  Slot* slot = pool.allocate(100);
  auto sweep = [&] { pool.sweep([](const Slot& each) { return !each.referred_to(); }); };
  slot->cells = 1;
  sweep();
  EXPECT_EQ(pool.find(kBegin), slot);
  slot->cells = 0;
  slot->messages = 1;
  sweep();
  EXPECT_EQ(pool.find(kBegin), slot);
  slot->messages = 0;
  sweep();
  EXPECT_EQ(pool.find(kBegin), nullptr);
}

/// Against a map of what is in use: no two overlap, and in the end all is there again.
TEST(SlotPool, KeepsItsRoomTogether) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    std::mt19937 random(seed);
    SlotPool pool(kBegin, kEnd);
    std::map<std::uint64_t, std::uint64_t> used;  // begin to bytes
    std::uint64_t warmest = 0, warmest_bytes = 0;
    for (int i = 0; i < 5000; ++i) {
      auto bytes = std::uint64_t{1} << random() % 18;
      bytes += random() % bytes;
      if (random() % 2 == 0 && !used.empty()) {
        auto entry = std::next(used.begin(), static_cast<long>(random() % used.size()));
        warmest = entry->first;
        warmest_bytes = entry->second;
        give_back(pool, warmest);
        used.erase(entry);
        continue;
      }
      bool reuses = random() % 2 == 0;
      if (reuses && warmest != 0 && random() % 2 == 0) bytes = warmest_bytes;
      Slot* slot = reuses ? pool.reuse(bytes) : pool.allocate(bytes);
      if (reuses && warmest != 0 && bytes == warmest_bytes) {
        ASSERT_NE(slot, nullptr);
        ASSERT_EQ(slot->begin, warmest);
      }
      warmest = 0;
      if (slot == nullptr) continue;
      ASSERT_GE(slot->bytes, bytes);
      ASSERT_EQ(slot->begin % kLine, 0U);
      ASSERT_EQ(pool.find(slot->begin), slot);
      ASSERT_GE(slot->begin, kBegin);
      ASSERT_LE(slot->begin + slot->bytes, kEnd);
      auto next = used.lower_bound(slot->begin);
      if (next != used.end()) {
        ASSERT_LE(slot->begin + slot->bytes, next->first);
      }
      if (next != used.begin()) {
        auto before = std::prev(next);
        ASSERT_LE(before->first + before->second, slot->begin);
      }
      used.emplace(slot->begin, slot->bytes);
    }
    pool.sweep([](const Slot&) { return true; });
    Slot* whole = pool.allocate(kEnd - kBegin);
    ASSERT_NE(whole, nullptr);
    EXPECT_EQ(whole->begin, kBegin);
  }
}

}  // namespace
}  // namespace hc::internal
