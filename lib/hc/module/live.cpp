// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include <hc/module/loop.h>

namespace hc {

class Module::Schedule::Live final : public Schedule {
 public:
  explicit Live(Loop& loop) : loop_(loop) {}

  void begin() override { attend(); }

  bool turn() override {
    if (!std::exchange(was_wait_short_, false)) loop_.now.read();
    loop_.inlets.receive_focus();
    const bool any = loop_.inlets.take_each();
    loop_.work_between_messages();
    if (any) return true;
    if (loop_.module.generate_) {
      loop_.generate();
      return true;
    }
    if (!loop_.module.options_.keep_running && loop_.inlets.all_ended()) return false;
    was_wait_short_ = loop_.wait(true, loop_.timers.next());
    return true;
  }

  void pause(const std::function<MonotonicTime()>& due) override {
    for (loop_.now.read(); loop_.now.machine < due(); loop_.now.read()) {
      loop_.wait(false, due());
      attend();
    }
  }

 private:
  /// The work during a pause, which takes no messages.
  void attend() {
    loop_.now.read();
    loop_.inlets.receive_focus();
    loop_.serve();
  }

  Loop& loop_;
  bool was_wait_short_ = false;  // the clock need not be read again
};

std::unique_ptr<Module::Schedule> Module::Schedule::live(Loop& loop) {
  return std::make_unique<Live>(loop);
}

}  // namespace hc
