// SPDX-License-Identifier: Apache-2.0
#pragma once
// A module's links to who runs it: reports go out, commands come in, both as messages like any
// other. Internal. doc/modules.md says what they look like.

#include <memory>
#include <span>
#include <string>
#include <vector>

#include <hc/link/link.h>

namespace hc::internal {

/// What a module reports, by the src of the message.
enum class Report : std::int32_t { Counters = 1, Links, Parameters, State, Refusal };

/// The two links, of which either may be missing. When one breaks, the module goes on without.
class Management {
 public:
  Management() = default;
  Management(std::unique_ptr<Sink> reports, std::unique_ptr<Source> commands)
      : reports_(std::move(reports)), commands_(std::move(commands)) {}

  [[nodiscard]] bool is_heard() const { return reports_ != nullptr; }
  /// Where commands come from; null where nobody sends any.
  [[nodiscard]] Source* commands() const { return commands_.get(); }

  /// The commands that have come, a line each. Never waits.
  std::vector<std::string> take_commands();

  /// Sends lines (links, parameters, a refusal). Never waits for who does not listen.
  void tell(Report report, std::span<const std::string> lines, std::int64_t time);
  /// Sends numbers: (rows, 1, columns), row by row.
  void tell(Report report, std::span<const std::int64_t> numbers, std::size_t columns,
            std::int64_t time);

 private:
  void send(Report report, Message message, std::int64_t time);

  std::unique_ptr<Sink> reports_;
  std::unique_ptr<Source> commands_;
  std::int64_t sent_ = 0;
};

}  // namespace hc::internal
