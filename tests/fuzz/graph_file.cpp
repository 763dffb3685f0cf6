// SPDX-License-Identifier: Apache-2.0
// Any text: a graph, or lines that say what is wrong with it; and any graph: a plan, or lines. The
// file may include itself under other names.
#include <graph/global_workspace.h>
#include <graph/plan.h>

namespace {

constexpr const char* kPorts =
    R"({"name":"m","inputs":[{"name":"i","actor":true,"types":[]},)"
    R"({"name":"frames","types":[]}],"outputs":[{"name":"o",)"
    R"("types":[{"type":"table","components":1,"scalar":"f64","width":0,"height":0,"coord":0}]},)"
    R"({"name":"focus","types":[{"type":"table","components":1,"scalar":"i32","width":1,"height":1,)"
    R"("coord":0}]}],"parameters":[{"name":"p","type":"integer","min":0,"fixed":true},)"
    R"({"name":"frames","type":"string"}],"transports":["shm","tcp","tcp-listen","unix","file"])";

/// What a program says of itself: much of it hangs on its name's first letter.
std::string describe(const std::string& program) {
  const bool routes = program.starts_with("r"), plain = program.starts_with("p");
  return std::string(kPorts) + (routes ? R"(,"routes":true)" : "") +
         (plain ? "}" : R"(,"control":true})");
}

}  // namespace

int fuzz_graph_file(const std::uint8_t* data, std::size_t size) {
  std::string_view text{reinterpret_cast<const char*>(data), size};
  hc::Problems problems("fuzz.toml");
  auto graph = hc::parse_graph(
      text, [](const char*) { return "value"; }, problems,
      [&](const std::string&) -> hc::Result<std::string> { return std::string(text); });
  auto ask = [](const std::string& program, const std::string&) -> hc::Result<std::string> {
    return describe(program);
  };
  auto plan = hc::make_plan(graph, ask, "fuzz", problems);
  for (const auto& line : problems.lines()) HC_CHECK(line.find(": ") != std::string::npos, line);
  if (!problems.empty()) return 0;
  HC_CHECK(plan.links.size() >= graph.links.size());
  HC_CHECK(plan.modules.size() == graph.modules.size());
  for (const auto& module : plan.modules) HC_CHECK(!module.command().empty());
  for (const auto& [mode, number] : plan.modes) {
    std::map<std::string, std::string> focus;
    for (const auto& workspace : plan.workspaces) focus[workspace] = mode;
    HC_CHECK(hc::global_workspace(plan, focus).links.size() <= plan.links.size());
  }
  return 0;
}
