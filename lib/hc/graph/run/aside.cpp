// SPDX-License-Identifier: Apache-2.0
#include <hc/graph/run/aside.h>

#include <sys/eventfd.h>

#include <utility>

namespace hc::internal {
namespace {

Result<int> make_event() {
  return system_call("eventfd", "", [] { return ::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC); });
}

}  // namespace

Result<std::unique_ptr<Aside>> Aside::make(Loop& loop) {
  auto stop = make_event();
  if (!stop) return stop.error();
  Descriptor stopped(*stop);
  auto ended = make_event();
  if (!ended) return ended.error();
  std::unique_ptr<Aside> aside(new Aside(std::move(stopped), Descriptor(*ended)));
  auto watched = loop.watch(*ended, EPOLLIN, [self = aside.get()](auto) { self->finish(); });
  if (!watched) return watched.error();
  aside->watch_ = std::move(*watched);
  return aside;
}

Aside::~Aside() {
  stop();
  if (thread_.joinable()) thread_.join();
}

void Aside::begin(Work work, std::function<void()> done) {
  eventfd_t count = 0;
  ::eventfd_read(stop_.get(), &count);
  is_stopped_ = false;
  done_ = std::move(done);
  thread_ = std::thread([work = std::move(work), stop = stop_.get(), ended = ended_.get()] {
    work(stop);
    ::eventfd_write(ended, 1);
  });
}

void Aside::stop() {
  if (!is_busy()) return;
  is_stopped_ = true;
  ::eventfd_write(stop_.get(), 1);
}

void Aside::finish() {
  eventfd_t count = 0;
  ::eventfd_read(ended_.get(), &count);
  thread_.join();
  std::exchange(done_, {})();
}

}  // namespace hc::internal
