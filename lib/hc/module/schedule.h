// SPDX-License-Identifier: Apache-2.0
#pragma once
// The order in which a module works. Internal.

#include <functional>
#include <memory>

#include <hc/base/uri.h>
#include <hc/module/module.h>

namespace hc {

class Module::Schedule {
 public:
  virtual ~Schedule() = default;
  /// Waits until the module can start, and sets its clock.
  virtual void begin() = 0;
  /// Does the next work, or waits for it; false at the end of all.
  virtual bool turn() = 0;
  /// Waits until a time that `due` gives, which may change meanwhile, as commands are obeyed.
  virtual void pause(const std::function<MonotonicTime()>& due) = 0;

  /// By the machine's clock: messages as they arrive, timers when they are due.
  static std::unique_ptr<Schedule> live(Loop& loop);
  /// By the messages' clock: messages in the order of their times, and timers between them. The
  /// result depends on the messages, and not on when they arrive.
  static std::unique_ptr<Schedule> by_messages(Loop& loop);
  /// By the trace of an earlier run: the same at the same moments.
  static std::unique_ptr<Schedule> replay(Loop& loop, const Uri& trace);

 private:
  class Live;
  class ByMessages;
  class Replay;
};

}  // namespace hc
