// SPDX-License-Identifier: Apache-2.0
#pragma once
// The order in which a module works. Internal.

#include <functional>
#include <memory>
#include <optional>

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
  /// The module reads its clock, which may be set before.
  virtual void read_clock() {}

  /// The schedule by the module's clock. @param trace  to be replayed.
  static std::unique_ptr<Schedule> make(Loop& loop, const std::optional<Uri>& trace);

 private:
  class Live;
  class ByMessages;
  class Replay;
};

}  // namespace hc
