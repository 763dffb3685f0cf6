// SPDX-License-Identifier: Apache-2.0
#include <hc/link/wait_set.h>

#include <sched.h>
#include <sys/epoll.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>

#include <hc/os/descriptor.h>

#if defined(__x86_64__) || defined(__i386__)
#include <emmintrin.h>
#endif

namespace hc {
namespace {

using std::chrono::nanoseconds;

constexpr std::chrono::microseconds kSpinAlone{1};   // until a reader that spins lets others run
constexpr std::size_t kSpinLooks = 16;               // at sources, between two looks at the clock
constexpr std::chrono::milliseconds kPollPeriod{1};  // of descriptors, while spinning
/// Spinning pays only where the next message comes soon: not after a wait longer than this many
/// times the spin. A module with a camera at 30 Hz would burn 20 µs an image for nothing.
constexpr int kShortWait = 4;
// What an event is about, if not the number of a source.
constexpr std::uint64_t kStop = 0, kOther = ~std::uint64_t{0};

void relax() {
#if defined(__x86_64__) || defined(__i386__)
  _mm_pause();
#endif
}

std::uint64_t next_number() {
  static std::atomic<std::uint64_t> last{0};
  return ++last;
}

/// epoll_wait() with a timeout in nanoseconds; below 0: none.
int wait_for_events(int poll, std::span<epoll_event> events, nanoseconds timeout) {
  const timespec time{timeout.count() / std::nano::den, timeout.count() % std::nano::den};
  return static_cast<int>(::syscall(SYS_epoll_pwait2, poll, events.data(),
                                    static_cast<int>(events.size()),
                                    timeout.count() < 0 ? nullptr : &time, nullptr, 0));
}

}  // namespace

Source::Source() : number_(next_number()) {}
Source::~Source() = default;

Result<bool> Source::wait(int stop, std::chrono::milliseconds timeout) {
  if (alone_ == nullptr || alone_->stop() != stop) alone_ = std::make_unique<WaitSet>(stop);
  std::array<Source*, 1> self = {this};
  return alone_->wait(self, timeout);
}

WaitSet::~WaitSet() {
  if (poll_ >= 0) ::close(poll_);
}

Status WaitSet::watch(int descriptor, std::uint32_t events, std::uint64_t what) {
  if (descriptor < 0) return {};
  epoll_event event{};
  event.events = events;
  event.data.u64 = what;
  const bool again = (events & EPOLLONESHOT) != 0;
  if (again && ::epoll_ctl(poll_, EPOLL_CTL_MOD, descriptor, &event) == 0) return {};
  if (::epoll_ctl(poll_, EPOLL_CTL_ADD, descriptor, &event) == 0 || errno == EEXIST) return {};
  if (errno != EPERM) return internal::system_error("epoll_ctl", "");
  never_sleeps_ = true;
  return {};
}

/// Sees that the sources that are waited for, and no others, are watched.
Status WaitSet::prepare(std::span<Source* const> sources) {
  auto is_watched = [](std::uint64_t number, const Source* source) {
    return number == source->number_;
  };
  if (poll_ >= 0 &&
      std::equal(watched_.begin(), watched_.end(), sources.begin(), sources.end(), is_watched))
    return {};
  // A new instance, since a descriptor of a source that is closed may be open elsewhere.
  if (poll_ >= 0) ::close(poll_);
  watched_.clear();
  never_sleeps_ = false;
  auto made =
      internal::system_call("epoll_create1", "", [] { return ::epoll_create1(EPOLL_CLOEXEC); });
  poll_ = made ? *made : -1;
  if (!made) return made.error();
  if (auto watched = watch(stop_, EPOLLIN, kStop); !watched) return watched;
  for (const Source* source : sources) {
    const auto number = source->number_;
    if (auto watched = watch(source->descriptor(), EPOLLIN, number); !watched) return watched;
    if (auto watched = watch(source->wake_descriptor(), EPOLLIN | EPOLLET, number); !watched)
      return watched;
  }
  for (const Source* source : sources) watched_.push_back(source->number_);
  return {};
}

/// Looks at what memory shows, some times.
bool WaitSet::look() const {
  for (std::size_t looks = 0; looks < kSpinLooks; looks += spins_.size()) {
    for (const auto& each : spins_)
      if (each.word->load(std::memory_order_acquire) >= each.value) return true;
    relax();
  }
  return false;
}

/// Looks for so long, and now and then at the descriptors.
Result<bool> WaitSet::spin(nanoseconds time) {
  last_wait_ = nanoseconds(0);
  was_short_ = look();
  if (was_short_) return true;
  const auto begin = Clock::now();
  auto next_poll = kPollPeriod;
  for (nanoseconds passed(0); passed < time; passed = Clock::now() - begin) {
    if (passed > next_poll) {
      next_poll += kPollPeriod;
      if (auto ready = sleep(nanoseconds(0)); !ready || *ready) return ready;
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

bool WaitSet::was_woken_by(const Source& source) const {
  return std::find(woken_by_.begin(), woken_by_.end(), source.number_) != woken_by_.end();
}

/// Waits for the descriptors.
Result<bool> WaitSet::sleep(nanoseconds timeout) {
  std::array<epoll_event, 8> events;
  auto count = internal::system_call("epoll_pwait2", "",
                                     [&] { return wait_for_events(poll_, events, timeout); });
  if (!count) return count.error();
  for (const auto& event : std::span(events).first(static_cast<std::size_t>(*count)))
    if (event.data.u64 == kStop)
      return Error{Code::Stopped, "asked to stop"};
    else
      woken_by_.push_back(std::uint64_t{event.data.u64});  // a copy, since the event is packed
  return *count > 0;
}

Result<bool> WaitSet::wait(std::span<Source* const> sources, std::span<const int> descriptors,
                           nanoseconds timeout) {
  woken_by_.clear();
  was_short_ = false;
  if (sources.size() == 1 && descriptors.empty() && sources[0]->wake_descriptor() < 0) {
    woken_by_.push_back(sources[0]->number_);
    return internal::wait_for(
        sources[0]->descriptor(), POLLIN, stop_,
        timeout.count() < 0 ? internal::Deadline::max() : Clock::now() + timeout);
  }
  if (auto prepared = prepare(sources); !prepared) return prepared.error();
  // Each time, since their owner may have closed one and opened another of the same number.
  for (int descriptor : descriptors)
    if (auto watched = watch(descriptor, EPOLLIN | EPOLLONESHOT, kOther); !watched)
      return watched.error();
  nanoseconds longest(0);
  spins_.clear();
  for (const Source* source : sources)
    if (auto each = source->spin(); each.word != nullptr && each.time.count() > 0) {
      longest = std::max<nanoseconds>(longest, each.time);
      spins_.push_back(each);
    }
  if (timeout.count() >= 0) longest = std::min(longest, timeout);
  if (longest.count() > 0 && last_wait_ <= kShortWait * longest)
    if (auto ready = spin(longest); !ready || *ready) return ready;
  const auto begin = Clock::now();
  bool is_ready = never_sleeps_;
  for (Source* source : sources) is_ready = !source->prepare_wait() || is_ready;
  if (is_ready) timeout = nanoseconds(0);  // but the wish to stop comes first
  auto ready = sleep(timeout);
  last_wait_ = Clock::now() - begin;
  if (!ready) return ready;
  return is_ready || *ready;
}

}  // namespace hc
