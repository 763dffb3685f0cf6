// SPDX-License-Identifier: Apache-2.0
// Any text: a graph, or one line that says what is wrong with it; and any graph: a plan, or one
// line.
#include <hc/graph/plan.h>

namespace {

constexpr const char* kDescription =
    R"({"name":"m","inputs":[{"name":"i","types":[{"type":"table","components":1,"scalar":"f64",)"
    R"("width":0,"height":0,"coord":0}]}],"outputs":[{"name":"o","types":[{"type":"table",)"
    R"("components":1,"scalar":"f64","width":0,"height":0,"coord":0}]}],"parameters":[{"name":"p"}]})";

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string_view text{reinterpret_cast<const char*>(data), size};
  auto graph = hc::parse_graph(text, "fuzz.toml", [](const char*) { return "value"; });
  if (!graph) {
    HC_CHECK(graph.error().code == hc::Code::Usage);
    HC_CHECK(graph.error().detail.starts_with("fuzz.toml:"), graph.error().detail);
    return 0;
  }
  auto describe = [](const std::string&) -> hc::Result<std::string> {
    return std::string(kDescription);
  };
  auto plan = hc::make_plan(*graph, describe, "fuzz");
  if (plan) HC_CHECK(plan->links.size() == graph->links.size());
  return 0;
}
