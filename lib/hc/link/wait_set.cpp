// SPDX-License-Identifier: Apache-2.0
#include <hc/link/wait_set.h>

#include <sys/epoll.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <utility>

#include <hc/link/shm/spin.h>

namespace hc {
namespace {

using std::chrono::nanoseconds;

constexpr std::uint64_t kStop = 0;  // the number of the stop descriptor

// How often descriptors are added again, since epoll silently drops one that is closed.
constexpr std::chrono::milliseconds kWatchPeriod{10};

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

Status WaitSet::watch(int descriptor, std::uint32_t events, std::uint64_t number) {
  if (descriptor < 0) return {};
  epoll_event event{};
  event.events = events;
  event.data.u64 = number;
  if (::epoll_ctl(poll_.get(), EPOLL_CTL_ADD, descriptor, &event) == 0 || errno == EEXIST)
    return {};
  if (errno != EPERM) return system_error("epoll_ctl", "");
  files_.push_back(number);
  return {};
}

/// Watches these sources and no others.
Status WaitSet::prepare(std::span<Source* const> sources) {
  if (poll_ && std::ranges::equal(sources_, sources, {}, {}, &Source::number_)) return {};
  // A new instance, since descriptors of sources may have been closed and opened elsewhere.
  poll_.reset();
  sources_.clear();
  descriptors_.clear();
  files_.clear();
  poll_ =
      HC_TRY(open_descriptor("epoll_create1", "", [] { return ::epoll_create1(EPOLL_CLOEXEC); }));
  HC_TRY(watch(stop_, EPOLLIN, kStop));
  for (const Source* source : sources) {
    HC_TRY(watch(source->descriptor(), EPOLLIN, source->number_));
    HC_TRY(watch(source->wake_descriptor(), EPOLLIN | EPOLLET, source->number_));
  }
  for (const Source* source : sources) sources_.push_back(source->number_);
  return {};
}

/// Watches these descriptors and no others, besides those of sources.
Status WaitSet::watch(std::span<const int> descriptors) {
  watched_at_ = Clock::now();
  for (int each : descriptors_)
    if (std::find(descriptors.begin(), descriptors.end(), each) == descriptors.end())
      ::epoll_ctl(poll_.get(), EPOLL_CTL_DEL, each, nullptr);  // it may have been closed
  descriptors_.assign(descriptors.begin(), descriptors.end());
  std::erase_if(files_, [](std::uint64_t number) { return (number & kDescriptors) != 0; });
  for (int each : descriptors) HC_TRY(watch(each, EPOLLIN, number_of(each)));
  return {};
}

/// Waits for the watched descriptors.
Result<bool> WaitSet::sleep(nanoseconds timeout) {
  if (!std::exchange(has_looked_, true)) woken_by_ = files_;
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
  was_short_ = has_looked_ = false;
  if (sources.size() == 1 && descriptors.empty() && sources[0]->wake_descriptor() < 0) {
    woken_by_.push_back(sources[0]->number_);
    return wait_for(sources[0]->descriptor(), POLLIN, stop_,
                    timeout.count() < 0 ? Deadline::max() : Clock::now() + timeout);
  }
  HC_TRY(prepare(sources));
  bool is_fresh = descriptors.empty();  // none can have been closed since it was added
  if (!std::ranges::equal(descriptors, descriptors_) ||
      (!is_fresh && Clock::now() - watched_at_ >= kWatchPeriod)) {
    HC_TRY(watch(descriptors));
    is_fresh = true;
  }
  auto found = spin_->run(sources, timeout, [&] { return sleep(nanoseconds(0)); });
  was_short_ = spin_->was_short();
  if (!found || *found) return found;
  const auto begin = Clock::now();
  bool is_ready = !files_.empty();
  for (Source* source : sources) is_ready = !source->prepare_wait() || is_ready;
  if (is_ready) timeout = nanoseconds(0);  // `stop` takes precedence
  const bool is_short = timeout.count() >= 0 && timeout <= kWatchPeriod;
  const nanoseconds first = is_fresh || is_short ? timeout : kWatchPeriod;
  auto ready = sleep(first);
  if (ready && !*ready && first != timeout) {
    HC_TRY(watch(descriptors));  // before it sleeps for long
    ready = sleep(timeout.count() < 0 ? timeout : timeout - first);
  }
  spin_->note_sleep(Clock::now() - begin);
  if (!ready) return ready;
  return is_ready || *ready;
}

}  // namespace hc
