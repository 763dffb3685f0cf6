// SPDX-License-Identifier: Apache-2.0
#include <hc/module/management.h>

#include <algorithm>

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

void Management::tell(Report report, std::span<const std::string> lines, std::int64_t time) {
  if (is_heard()) send(report, make_rows(lines), time);
}

void Management::tell(Report report, std::span<const std::int64_t> numbers, std::size_t columns,
                      std::int64_t time) {
  if (!is_heard()) return;
  const Info info{MatrixType::Table, static_cast<std::uint8_t>(columns), Scalar::I64,
                  Encoding::Text};
  Draft draft = Draft::make(info, 1, static_cast<std::int32_t>(numbers.size() / columns));
  std::copy(numbers.begin(), numbers.end(), draft.view<std::int64_t>().numbers().begin());
  send(report, std::move(draft).finish(), time);
}

void Management::send(Report report, Message message, std::int64_t time) {
  message.header.src = static_cast<std::int32_t>(report);
  message.header.seq = sent_++;
  message.header.time = time;
  // Who does not listen to our reports does not stop our work.
  if (!reports_->send(message)) reports_.reset();
}

}  // namespace hc::internal
