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

constexpr std::chrono::microseconds kSpinAlone{2};   // until a reader that spins lets others run
constexpr std::size_t kSpinLooks = 32;               // at sources, between two looks at the clock
constexpr std::chrono::milliseconds kPollPeriod{1};  // of descriptors, while spinning
/// Spinning pays only where the next message comes soon: not after a wait longer than this many
/// times the spin. A module with a camera at 30 Hz would burn 20 µs an image for nothing.
constexpr int kShortWait = 4;
constexpr std::uint64_t kStop = 0, kOther = 1;  // what an event is about

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

Status WaitSet::watch(int descriptor, std::uint32_t events) {
  if (descriptor < 0) return {};
  epoll_event event{};
  event.events = events;
  event.data.u64 = descriptor == stop_ ? kStop : kOther;
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
  // A new instance, since a descriptor of a source that is gone may live on elsewhere.
  if (poll_ >= 0) ::close(poll_);
  watched_.clear();
  never_sleeps_ = false;
  auto made =
      internal::system_call("epoll_create1", "", [] { return ::epoll_create1(EPOLL_CLOEXEC); });
  poll_ = made ? *made : -1;
  if (!made) return made.error();
  if (auto watched = watch(stop_, EPOLLIN); !watched) return watched;
  for (const Source* source : sources) {
    if (auto watched = watch(source->descriptor(), EPOLLIN); !watched) return watched;
    if (auto watched = watch(source->wake_descriptor(), EPOLLIN | EPOLLET); !watched)
      return watched;
  }
  for (const Source* source : sources) watched_.push_back(source->number_);
  return {};
}

/// Looks at what memory shows, until it is time to poll descriptors.
bool WaitSet::look(nanoseconds spin, nanoseconds& passed, Clock::time_point begin) const {
  for (const auto end = std::min(spin, passed + kPollPeriod); passed < end;) {
    for (std::size_t looks = 0; looks < kSpinLooks; looks += spins_.size()) {
      for (const auto& each : spins_)
        if (each.word->load(std::memory_order_acquire) >= each.value) return true;
      relax();
    }
    passed = Clock::now() - begin;
    if (passed > kSpinAlone) ::sched_yield();
  }
  return false;
}

/// Waits for the descriptors.
Result<bool> WaitSet::sleep(nanoseconds timeout) {
  std::array<epoll_event, 8> events;
  auto count = internal::system_call("epoll_pwait2", "",
                                     [&] { return wait_for_events(poll_, events, timeout); });
  if (!count) return count.error();
  for (const auto& event : std::span(events).first(static_cast<std::size_t>(*count)))
    if (event.data.u64 == kStop) return Error{Code::Stopped, "asked to stop"};
  return *count > 0;
}

Result<bool> WaitSet::wait(std::span<Source* const> sources, std::span<const int> descriptors,
                           nanoseconds timeout) {
  const auto begin = Clock::now();
  if (sources.size() == 1 && descriptors.empty() && sources[0]->wake_descriptor() < 0)
    return internal::wait_for(sources[0]->descriptor(), POLLIN, stop_,
                              timeout.count() < 0 ? internal::Deadline::max() : begin + timeout);
  if (auto prepared = prepare(sources); !prepared) return prepared.error();
  // Each time, since their owner may have closed one and opened another of the same number.
  for (int descriptor : descriptors)
    if (auto watched = watch(descriptor, EPOLLIN | EPOLLONESHOT); !watched) return watched.error();
  nanoseconds spin(0), passed(0);
  spins_.clear();
  for (const Source* source : sources)
    if (auto each = source->spin(); each.word != nullptr && each.time.count() > 0) {
      spin = std::max<nanoseconds>(spin, each.time);
      spins_.push_back(each);
    }
  if (timeout.count() >= 0) spin = std::min(spin, timeout);
  if (last_wait_ > kShortWait * spin) spin = nanoseconds(0);
  while (passed < spin) {
    last_wait_ = nanoseconds(0);
    if (look(spin, passed, begin)) return true;
    if (passed >= spin) break;
    if (auto ready = sleep(nanoseconds(0)); !ready || *ready) return ready;
  }
  bool is_ready = never_sleeps_;
  for (Source* source : sources) is_ready = !source->prepare_wait() || is_ready;
  if (is_ready) timeout = nanoseconds(0);  // but the wish to stop comes first
  auto ready = sleep(timeout);
  last_wait_ = Clock::now() - begin;
  if (!ready) return ready;
  return is_ready || *ready;
}

}  // namespace hc
