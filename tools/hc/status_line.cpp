// SPDX-License-Identifier: Apache-2.0
#include "status_line.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <map>

#include <hc/base/format.h>

namespace tool {

std::string summary_of(const hc::GraphState& state) {
  std::map<hc::ModuleStatus, int> counts;
  for (const auto& module : state.modules) ++counts[module.status];
  std::string modules;
  for (auto status :
       {hc::ModuleStatus::Running, hc::ModuleStatus::Starting, hc::ModuleStatus::Stalled,
        hc::ModuleStatus::Waiting, hc::ModuleStatus::Stopping, hc::ModuleStatus::Ended,
        hc::ModuleStatus::GivenUp})
    if (counts[status] > 0)
      modules +=
          hc::format("{}{} {}", modules.empty() ? "" : ", ", counts[status], hc::name(status));
  double rate = 0;
  for (const auto& link : state.links) rate += link.per_second;
  std::string text = hc::format("{} | {:.0f} messages/s", modules, rate);
  if (const auto focus = state.focus_in_words(); !focus.empty()) text += " | focus: " + focus;
  if (const auto stopped = state.stopped_in_words(); !stopped.empty()) text += " | " + stopped;
  return text;
}

StatusLine::StatusLine(bool wanted)
    : on_terminal_(wanted && ::isatty(STDERR_FILENO) == 1), outbox_(STDERR_FILENO) {}

void StatusLine::show(const hc::GraphState& state) {
  if (!on_terminal_) return;
  winsize size{};
  const std::size_t width =
      ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
  outbox_.show(summary_of(state).substr(0, width - 1));
}

}  // namespace tool
