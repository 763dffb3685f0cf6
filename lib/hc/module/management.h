// SPDX-License-Identifier: Apache-2.0
#pragma once
// A module's links to who runs it: reports go out, commands come in, both as messages like any
// other (spec/module.md). Internal.

#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include <hc/contract/report.h>
#include <hc/link/link.h>

namespace hc::internal {

/// The two links, of which either may be missing. When one breaks, the module continues without it.
class Management {
 public:
  void open(std::unique_ptr<Sink> reports, std::unique_ptr<Source> commands) {
    reports_ = std::move(reports);
    commands_ = std::move(commands);
  }

  [[nodiscard]] bool is_heard() const { return reports_ != nullptr; }
  /// Where commands come from; null where nobody sends any.
  [[nodiscard]] Source* commands() const { return commands_.get(); }

  /// The commands that have come, a line each. Never waits.
  std::vector<std::string> take_commands();

  /// Sends a report, which is dropped if the reader is too slow. From any thread. False: no reader.
  bool send(Report report, Message message, std::int64_t time);

 private:
  std::mutex mutex_;  // of the reports
  std::unique_ptr<Sink> reports_;
  std::unique_ptr<Source> commands_;
  std::int64_t sent_ = 0;
};

}  // namespace hc::internal
