// SPDX-License-Identifier: Apache-2.0
#include <graph/run/graph_log.h>

#include <utility>

namespace hc::internal {

constexpr std::size_t kMostResults = 100, kMostNotices = 100;

void GraphLog::print(const LogLine& line) const {
  if (options_.event) options_.event(line);
}

void GraphLog::add(const LogLine& line) {
  print(line);
  if (server_ != nullptr) server_->log(line);
}

void GraphLog::take(LogLine line) {
  if (is_stopping_ && line.level == Level::Warning) return;
  line.text = with_link_names(std::move(line.text));
  const bool is_error = line.level == Level::Error;
  if ((is_error || line.level == Level::Result) && results_.size() < kMostResults)
    results_.push_back(line);
  if (options_.with_module_lines || is_error || line.level == Level::Notice) print(line);
  if (line.level == Level::Notice) {
    notices_.push_back(std::move(line));
    if (notices_.size() > kMostNotices) notices_.pop_front();
  } else if (server_ != nullptr) {
    server_->log(line);
  }
}

std::string GraphLog::with_link_names(std::string line) const {
  const bool has_token = !plan_.token.empty() && line.find(plan_.token) != std::string::npos;
  if (!has_token && plan_.ports.empty()) return line;
  for (const auto& link : plan_.links)
    for (const auto* uri : {&link.reader_uri, &link.sender_uri}) {
      const bool is_inside = !link.reader_uri.empty() && !link.sender_uri.empty();
      const auto found = is_inside ? line.find(*uri) : std::string::npos;
      if (found != std::string::npos)
        return line.replace(found, uri->size(), link.from + " → " + link.to);
    }
  return line;
}

}  // namespace hc::internal
