// SPDX-License-Identifier: Apache-2.0
#include <hc/contract/running_graph.h>

#include <algorithm>
#include <charconv>

namespace hc {

bool is_of_graph_name(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ||
         c == '_';
}

std::optional<RunningGraph> parse_running_graph(std::string_view text) {
  const auto dot = text.find('.');
  if (dot == std::string_view::npos || dot == 0 || dot > kMaxGraphName) return std::nullopt;
  RunningGraph graph;
  graph.name = text.substr(0, dot);
  if (!std::ranges::all_of(graph.name, is_of_graph_name)) return std::nullopt;
  const char *begin = text.data() + dot + 1, *end = text.data() + text.size();
  const auto [stop, status] = std::from_chars(begin, end, graph.process);
  if (status != std::errc() || stop != end || graph.process <= 0) return std::nullopt;
  return graph;
}

}  // namespace hc
