// SPDX-License-Identifier: Apache-2.0
// Reads a graph and a URI, to see that the layers below link by themselves.
#include <hc/base/uri.h>
#include <hc/graph/graph_file.h>

int main() {
  auto graph = hc::parse_graph("[modules.camera]\n", "a.toml", [](const char*) { return nullptr; });
  return graph && graph->modules.size() == 1 && hc::parse_uri("tcp:localhost:1") ? 0 : 1;
}
