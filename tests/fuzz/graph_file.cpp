// SPDX-License-Identifier: Apache-2.0
// Any text: a graph, or lines that say what is wrong with it; and any graph: a plan, or lines.
#include <hc/graph/plan.h>

namespace {

constexpr const char* kDescription =
    R"({"name":"m","inputs":[{"name":"i","types":[{"type":"table","components":1,"scalar":"f64",)"
    R"("width":0,"height":0,"coord":0}]}],"outputs":[{"name":"o","types":[{"type":"table",)"
    R"("components":1,"scalar":"f64","width":0,"height":0,"coord":0}]}],"parameters":[{"name":"p"}]})";

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string_view text{reinterpret_cast<const char*>(data), size};
  hc::Problems problems("fuzz.toml");
  auto graph = hc::parse_graph(
      text, [](const char*) { return "value"; }, problems);
  auto describe = [](const std::string&) -> hc::Result<std::string> {
    return std::string(kDescription);
  };
  auto plan = hc::make_plan(graph, describe, "fuzz", problems);
  for (const auto& line : problems.lines()) HC_CHECK(line.starts_with("fuzz.toml:"), line);
  if (problems.empty()) HC_CHECK(plan.links.size() == graph.links.size());
  return 0;
}
