// SPDX-License-Identifier: Apache-2.0
#include <hc/os/aside.h>

namespace hc {

Result<Aside> Aside::begin(Loop& loop, std::function<void(int stop)> work,
                           std::function<void()> done) {
  auto event = HC_TRY(Event::make());
  Aside aside;
  aside.state_ = std::make_shared<State>(State{std::move(event), false, std::move(done), {}});
  // The thread must not own the state, which holds the thread.
  aside.state_->thread =
      HC_TRY(start_thread([&loop, work = std::move(work), stop = aside.state_->stop.descriptor(),
                           begun = std::weak_ptr(aside.state_)] {
        work(stop);
        loop.post([begun] {
          const auto state = begun.lock();
          if (!state || !state->thread.joinable()) return;
          state->thread.join();
          std::exchange(state->done, {})();
        });
      }));
  return aside;
}

Aside::~Aside() {
  if (!is_busy()) return;
  stop();
  state_->thread.join();
}

void Aside::stop() {
  if (!is_busy()) return;
  state_->is_stopped = true;
  state_->stop.raise();
}

}  // namespace hc
