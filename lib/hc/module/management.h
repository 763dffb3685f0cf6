// SPDX-License-Identifier: Apache-2.0
#pragma once
// A module's links to `hc run`, for reports and commands (spec/module.md). Internal.

#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include <hc/contract/report.h>
#include <hc/link/link.h>

namespace hc::internal {

/// The two links; either may be missing. If one breaks, the module continues without it.
class Management {
 public:
  void open(std::unique_ptr<Sink> reports, std::unique_ptr<Source> commands) {
    reports_ = std::move(reports);
    commands_ = std::move(commands);
  }

  [[nodiscard]] bool is_heard() const { return reports_ != nullptr; }
  /// The link for commands; null: none.
  [[nodiscard]] Source* commands() const { return commands_.get(); }

  /// Takes the commands that have arrived, one per element. Never waits.
  std::vector<std::string> take_commands();

  /// Sends a report, or drops it if the reader is slow. From any thread. False: no reader.
  bool send(Report report, Message message, Time time);

 private:
  std::mutex mutex_;  // of reports_ and sent_
  std::unique_ptr<Sink> reports_;
  std::unique_ptr<Source> commands_;
  std::int64_t sent_ = 0;
};

}  // namespace hc::internal
