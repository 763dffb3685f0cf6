// SPDX-License-Identifier: Apache-2.0
// Waiting for a message: spinning, then asleep on the publisher's futex, then on the socket.
#include <hc/link/shm/source.h>

#include <sched.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>

#include <hc/link/shm/crash_point.h>
#include <hc/link/stream/source.h>

#if defined(__x86_64__) || defined(__i386__)
#include <emmintrin.h>
#endif

namespace hc::internal {
namespace {

using std::memory_order_acquire;
using std::memory_order_relaxed;
using std::memory_order_seq_cst;
using Clock = std::chrono::steady_clock;

/// How long one sleeps on the futex, which is quick to wake but hears of nothing else, before one
/// waits on the socket.
constexpr std::chrono::milliseconds kFutexTime{100};
constexpr std::chrono::microseconds kSpinAlone{2};  // until one who spins lets others run
constexpr int kSpinRounds = 32;                     // between two looks at the clock
constexpr std::chrono::milliseconds kSpinLook{1};   // how often one who spins looks at all else

constexpr unsigned kLookSeldom = 8;  // waits, until one looks at a silent link

void relax() {
#if defined(__x86_64__) || defined(__i386__)
  _mm_pause();
#endif
}

}  // namespace

bool ShmSource::is_ready() const {
  return attachment_->cell(cursor_).stamp.load(memory_order_acquire) > cursor_ || has_ended();
}

/// Takes the bytes that woke us, and notices when the publisher has gone.
void ShmSource::look_at_socket() {
  std::array<char, 64> bytes;
  const auto most = static_cast<ssize_t>(bytes.size());
  ssize_t size = most;
  while (size == most)
    size = ::recv(attachment_->socket.get(), bytes.data(), bytes.size(), MSG_DONTWAIT);
  // Behind a short read there is nothing but, perhaps, the end: poll() tells of that again.
  if (size > 0 || (size < 0 && (errno == EAGAIN || errno == EINTR))) return;
  publisher_gone_ = true;
}

void ShmSource::arm(bool on_socket) {
  arming_ += 2;
  std::uint32_t value = (arming_ == 0 ? arming_ = 2 : arming_) | (on_socket ? 1 : 0);
  attachment_->own().armed.store(value, memory_order_relaxed);
  armed_ = true;
  HC_CRASH_POINT("reader armed");
  std::atomic_thread_fence(memory_order_seq_cst);  // wake
  if (attachment_->head().unfenced.load(memory_order_acquire) != 0) order_everywhere();
}

bool ShmSource::prepare_wait() {
  // Who is armed still was woken by another link: nothing but the end can have come meanwhile.
  if (!armed_ || ++unlooked_ % kLookSeldom == 0) look_at_socket();
  arm(true);
  if (!is_ready()) return true;
  disarm();
  return false;
}

Result<bool> ShmSource::wait(int stop, std::chrono::milliseconds timeout) {
  const auto begin = Clock::now();
  auto passed = [&] { return Clock::now() - begin; };
  auto is_over = [&] { return timeout.count() >= 0 && passed() >= timeout; };
  auto look = [&]() -> Status {
    look_at_socket();
    auto stopped = wait_readable({}, stop, std::chrono::milliseconds(0));
    return stopped ? Status() : stopped.error();
  };
  for (auto next_look = begin + kSpinLook; passed() < spin_;) {
    for (int i = 0; i < kSpinRounds; ++i) {
      if (is_ready()) return true;
      relax();
    }
    if (passed() > kSpinAlone) ::sched_yield();
    if (is_over()) return false;
    if (Clock::now() < next_look) continue;
    if (auto looked = look(); !looked) return looked.error();
    next_look = Clock::now() + kSpinLook;
  }
  const auto slept_from = Clock::now();
  while (true) {
    auto signal = attachment_->head().signal.load(memory_order_acquire);
    arm(false);
    if (is_ready()) {
      disarm();
      return true;
    }
    if (is_over()) {
      disarm();
      return false;
    }
    auto left = kFutexTime - (Clock::now() - slept_from);
    if (left <= Clock::duration(0) || publisher_gone_) break;
    if (timeout.count() >= 0) left = std::min<Clock::duration>(left, timeout - passed());
    futex_wait(attachment_->head().signal, signal, left);
    if (is_ready()) continue;
    if (auto looked = look(); !looked) return looked.error();
  }
  if (!prepare_wait()) return true;
  auto left = std::chrono::milliseconds(-1);
  if (timeout.count() >= 0)
    left = std::max(std::chrono::ceil<std::chrono::milliseconds>(timeout - passed()),
                    std::chrono::milliseconds(0));
  std::array<int, 1> descriptors = {descriptor()};
  auto ready = wait_readable(descriptors, stop, left);
  if (!ready) return ready.error();
  return *ready == 0;
}

}  // namespace hc::internal
