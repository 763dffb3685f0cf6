// SPDX-License-Identifier: Apache-2.0
#include <hc/link/shm/spin.h>

#include <sched.h>

#include <algorithm>

#if defined(__x86_64__) || defined(__i386__)
#include <emmintrin.h>
#endif

namespace hc::internal {
namespace {

using std::chrono::nanoseconds;

constexpr std::chrono::microseconds kSpinAlone{1};   // then it yields the processor
constexpr std::size_t kSpinLooks = 16;               // at words, between two reads of the clock
constexpr std::chrono::milliseconds kPollPeriod{1};  // of descriptors, while spinning
constexpr int kShortWait = 4;  // the longest wait after which it spins, in spins

void relax() {
#if defined(__x86_64__) || defined(__i386__)
  _mm_pause();
#endif
}

}  // namespace

/// Reads the words a number of times.
bool Spin::look() const {
  for (std::size_t looks = 0; looks < kSpinLooks; looks += words_.size()) {
    for (const auto& each : words_)
      if (each.word->load(std::memory_order_acquire) >= each.value) return true;
    relax();
  }
  return false;
}

Result<bool> Spin::run(std::span<Source* const> sources, nanoseconds timeout,
                       const std::function<Result<bool>()>& poll) {
  was_short_ = false;
  nanoseconds longest(0);
  words_.clear();
  for (const Source* source : sources)
    if (auto each = source->spin(); each.word != nullptr && each.time.count() > 0) {
      longest = std::max<nanoseconds>(longest, each.time);
      words_.push_back(each);
    }
  if (timeout.count() >= 0) longest = std::min(longest, timeout);
  if (longest.count() <= 0 || last_wait_ > kShortWait * longest) return false;

  last_wait_ = nanoseconds(0);
  was_short_ = look();
  if (was_short_) return true;
  const auto begin = Clock::now();
  auto next_poll = kPollPeriod;
  for (nanoseconds passed(0); passed < longest; passed = Clock::now() - begin) {
    if (passed > next_poll) {
      next_poll += kPollPeriod;
      if (auto ready = poll(); !ready || *ready) return ready;
    }
    const bool is_long = passed > kSpinAlone;
    if (is_long) ::sched_yield();
    if (look()) {
      was_short_ = !is_long;
      return true;
    }
  }
  return false;
}

}  // namespace hc::internal
