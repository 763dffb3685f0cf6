// SPDX-License-Identifier: Apache-2.0
#include <graph/run/aside.h>

#include <utility>

namespace hc::internal {

Result<std::unique_ptr<Aside>> Aside::make(Loop& loop) {
  auto stop = Event::make();
  if (!stop) return stop.error();
  auto ended = Event::make();
  if (!ended) return ended.error();
  std::unique_ptr<Aside> aside(new Aside(std::move(*stop), std::move(*ended)));
  auto watched = loop.watch(aside->ended_.descriptor(), EPOLLIN,
                            [self = aside.get()](auto) { self->finish(); });
  if (!watched) return watched.error();
  aside->watch_ = std::move(*watched);
  return aside;
}

Aside::~Aside() {
  stop();
  if (thread_.joinable()) thread_.join();
}

void Aside::begin(Work work, std::function<void()> done) {
  stop_.clear();
  is_stopped_ = false;
  done_ = std::move(done);
  thread_ = std::thread([this, work = std::move(work)] {
    work(stop_.descriptor());
    ended_.raise();
  });
}

void Aside::stop() {
  if (!is_busy()) return;
  is_stopped_ = true;
  stop_.raise();
}

void Aside::finish() {
  ended_.clear();
  thread_.join();
  std::exchange(done_, {})();
}

}  // namespace hc::internal
