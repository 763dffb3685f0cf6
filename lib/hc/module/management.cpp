// SPDX-License-Identifier: Apache-2.0
#include <hc/module/management.h>

#include <hc/mtp/rows.h>

namespace hc::internal {

std::vector<std::string> Management::take_commands() {
  std::vector<std::string> commands;
  Message message;
  while (commands_ != nullptr) {
    auto got = commands_->take(message);
    if (got && *got == Got::Nothing) break;
    if (got && *got == Got::Message)
      for (auto& row : rows_of(message)) commands.push_back(std::move(row));
    else
      commands_.reset();
  }
  return commands;
}

bool Management::send(Report report, Message message, Time time) {
  const std::lock_guard lock(mutex_);
  if (reports_ == nullptr) return false;
  message.header.src = static_cast<std::int32_t>(report);
  message.header.seq = sent_++;
  message.header.time = time;
  if (!reports_->send(message)) reports_.reset();
  return reports_ != nullptr;
}

}  // namespace hc::internal
