// SPDX-License-Identifier: Apache-2.0
#include <hc/link/wait_set.h>

#include <sys/epoll.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>

#include <hc/link/shm/spin.h>

namespace hc {
namespace {

using std::chrono::nanoseconds;

// Values of epoll_event::data, besides the numbers of sources.
constexpr std::uint64_t kStop = 0, kOther = ~std::uint64_t{0};

std::uint64_t next_number() {
  static std::atomic<std::uint64_t> last{0};
  return ++last;
}

/// epoll_wait() with a timeout in nanoseconds; negative: none.
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

Result<bool> receive(Source& source, Message& message, int stop) {
  while (true) {
    const Got got = HC_TRY(source.take(message));
    if (got != Got::Nothing) return got == Got::Message;
    HC_TRY(source.wait(stop));
  }
}

WaitSet::WaitSet(int stop) : stop_(stop), spin_(std::make_unique<internal::Spin>()) {}

WaitSet::~WaitSet() = default;

Status WaitSet::watch(int descriptor, std::uint32_t events, std::uint64_t what) {
  if (descriptor < 0) return {};
  epoll_event event{};
  event.events = events;
  event.data.u64 = what;
  const bool again = (events & EPOLLONESHOT) != 0;
  if (again && ::epoll_ctl(poll_.get(), EPOLL_CTL_MOD, descriptor, &event) == 0) return {};
  if (::epoll_ctl(poll_.get(), EPOLL_CTL_ADD, descriptor, &event) == 0 || errno == EEXIST)
    return {};
  if (errno != EPERM) return system_error("epoll_ctl", "");
  never_sleeps_ = true;
  return {};
}

/// Watches exactly these sources.
Status WaitSet::prepare(std::span<Source* const> sources) {
  auto is_watched = [](std::uint64_t number, const Source* source) {
    return number == source->number_;
  };
  if (poll_ &&
      std::equal(watched_.begin(), watched_.end(), sources.begin(), sources.end(), is_watched))
    return {};
  // A new instance, since the descriptor of a closed source may have been reused.
  poll_.reset();
  watched_.clear();
  never_sleeps_ = false;
  poll_ =
      HC_TRY(open_descriptor("epoll_create1", "", [] { return ::epoll_create1(EPOLL_CLOEXEC); }));
  HC_TRY(watch(stop_, EPOLLIN, kStop));
  for (const Source* source : sources) {
    const auto number = source->number_;
    HC_TRY(watch(source->descriptor(), EPOLLIN, number));
    HC_TRY(watch(source->wake_descriptor(), EPOLLIN | EPOLLET, number));
  }
  for (const Source* source : sources) watched_.push_back(source->number_);
  return {};
}

bool WaitSet::was_woken_by(const Source& source) const {
  return std::find(woken_by_.begin(), woken_by_.end(), source.number_) != woken_by_.end();
}

/// Waits for the descriptors only.
Result<bool> WaitSet::sleep(nanoseconds timeout) {
  std::array<epoll_event, 8> events;
  const int count = HC_TRY(system_call(
      "epoll_pwait2", "", [&] { return wait_for_events(poll_.get(), events, timeout); }));
  for (const auto& event : std::span(events).first(static_cast<std::size_t>(count)))
    if (event.data.u64 == kStop)
      return Error{Code::Stopped, "asked to stop"};
    else
      woken_by_.push_back(std::uint64_t{event.data.u64});  // a copy, since the event is packed
  return count > 0;
}

Result<bool> WaitSet::wait(std::span<Source* const> sources, std::span<const int> descriptors,
                           nanoseconds timeout) {
  woken_by_.clear();
  was_short_ = false;
  if (sources.size() == 1 && descriptors.empty() && sources[0]->wake_descriptor() < 0) {
    woken_by_.push_back(sources[0]->number_);
    return wait_for(sources[0]->descriptor(), POLLIN, stop_,
                    timeout.count() < 0 ? Deadline::max() : Clock::now() + timeout);
  }
  HC_TRY(prepare(sources));
  // On each wait, since the owner may have closed a descriptor and opened another with its number.
  for (int descriptor : descriptors) HC_TRY(watch(descriptor, EPOLLIN | EPOLLONESHOT, kOther));
  auto found = spin_->run(sources, timeout, [&] { return sleep(nanoseconds(0)); });
  was_short_ = spin_->was_short();
  if (!found || *found) return found;
  const auto begin = Clock::now();
  bool is_ready = never_sleeps_;
  for (Source* source : sources) is_ready = !source->prepare_wait() || is_ready;
  if (is_ready) timeout = nanoseconds(0);  // `stop` takes precedence
  auto ready = sleep(timeout);
  spin_->note_sleep(Clock::now() - begin);
  if (!ready) return ready;
  return is_ready || *ready;
}

}  // namespace hc
