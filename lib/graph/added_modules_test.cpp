// SPDX-License-Identifier: Apache-2.0
#include <graph/added_modules.h>

#include <gtest/gtest.h>

#include <hc/testing/must.h>

namespace hc {
namespace {

Result<Graph> graph_of(const std::string& text) {
  Problems problems("g.toml");
  Graph graph = parse_graph(
      "version = 1\n" + text, [](const char*) { return nullptr; }, problems);
  if (problems.empty()) return graph;
  return Error{Code::Invalid, problems.lines().front()};
}

TEST(AddedModules, EveryLinkedOutputIsRecordedOnce) {
  auto graph = must(graph_of(R"([modules.a]
[modules.b]
[modules.w]
[workspace]
module = "w"
[[modules.b.inputs.in]]
from = "a.out"
[[modules.b.inputs.other]]
from = "a.out"
[[modules.b.inputs.in]]
from = "tcp:7000"
)"));
  const auto inputs =
      add_recorder(graph, {{"b", "trace", ""}}, "/bin/recorder", {{"file", "x.mcap"}});
  EXPECT_EQ(inputs.size(), 3U);
  ASSERT_EQ(graph.links.size(), 6U);
  const char* outputs[] = {"a.out", "b.trace", "w.focus"};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(graph.links[3 + i].from.text(), outputs[i]);
    EXPECT_EQ(graph.links[3 + i].to.text(), "recorder.stream_" + std::to_string(i));
    EXPECT_EQ(graph.links[3 + i].policy.at("keep").value, "1024");
  }
}

TEST(AddedModules, AFolderIsRecordedWhole) {
  auto graph = must(graph_of(R"([modules.a]
[modules.recorder]
inputs.in = "a.out"
)"));
  add_recorder(graph, {{"a", "trace", ""}}, "/bin/recorder", {{"folder", "kept"}});
  const auto& recorder = graph.modules.back();
  EXPECT_EQ(recorder.name, "recorder_added");  // "recorder" is taken
  EXPECT_EQ(recorder.parameters.at("folder").value, "kept");
  EXPECT_EQ(recorder.parameters.at("streams").value, "stream_0=a.out stream_1=a.trace");
  ASSERT_EQ(graph.links.size(), 3U);
  EXPECT_EQ(graph.links[2].from.text() + " " + graph.links[2].to.text(),
            "a.trace recorder_added.stream_1");
  EXPECT_EQ(graph.links[2].policy.at("keep").value, "all");
}

}  // namespace
}  // namespace hc
