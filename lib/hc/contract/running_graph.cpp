// SPDX-License-Identifier: Apache-2.0
#include <hc/contract/running_graph.h>

#include <algorithm>

#include <hc/base/text.h>

namespace hc {

bool is_of_graph_name(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ||
         c == '_';
}

std::optional<RunningGraph> parse_running_graph(std::string_view text) {
  RunningGraph graph;
  graph.name = take_until(text, '.');
  const bool is_named = !graph.name.empty() && graph.name.size() <= kMaxGraphName &&
                        std::ranges::all_of(graph.name, is_of_graph_name);
  if (!is_named || !read_number(text, graph.process) || graph.process <= 0) return std::nullopt;
  return graph;
}

}  // namespace hc
