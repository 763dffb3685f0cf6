// SPDX-License-Identifier: Apache-2.0
#include <graph/added_modules.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include <hc/contract/description.h>
#include <hc/contract/trace.h>

namespace hc {
namespace {

/// Whether a module is the last of a chain: links lead to it, and none from it.
bool is_last(const Graph& graph, const std::string& module) {
  bool is_fed = false, feeds = false;
  for (const auto& link : graph.links) {
    is_fed |= link.to.module == module;
    feeds |= link.from.module == module;
  }
  for (const auto& workspace : graph.workspaces) feeds |= workspace.value == module;
  for (const auto& frame : graph.frames)
    feeds |= frame.moved_by && frame.moved_by->value.module == module;
  return is_fed && !feeds;
}

/// The outputs to record, with the place where each is first named.
std::map<std::pair<std::string, std::string>, Place> recorded_outputs(
    const Graph& graph, const std::vector<GraphPort>& unlinked) {
  std::map<std::pair<std::string, std::string>, Place> outputs;
  for (const auto& link : graph.links)
    if (link.from.uri.empty())
      outputs.emplace(std::pair(link.from.module, link.from.port), link.place);
  for (const auto& workspace : graph.workspaces)
    outputs.emplace(std::pair(workspace.value, "focus"), workspace.place);
  for (const auto& frame : graph.frames)
    if (frame.moved_by)
      outputs.emplace(std::pair(frame.moved_by->value.module, frame.moved_by->value.port),
                      frame.moved_by->place);
  for (const auto& output : unlinked)
    outputs.emplace(std::pair(output.module, output.port),
                    find_named(graph.modules, output.module)->place);
  return outputs;
}

}  // namespace

void add_page(Graph& graph, const std::string& listen, Problems& problems) {
  auto obey = [&](const std::string& line) {
    apply_command(graph, parse_graph_command(line).value(), problems);
  };
  auto runs = [](const GraphModule& module, std::string_view program) {
    return std::filesystem::path(module.program.value).filename() == program;
  };
  std::string page = "web";
  const auto known = std::ranges::find_if(
      graph.modules, [&](const GraphModule& module) { return runs(module, "web"); });
  if (known != graph.modules.end()) {
    page = known->name;
  } else {
    while (graph.find(page) != nullptr) page += "_page";
    obey("add " + page + " web");
    const std::string arbiter = graph.workspaces.empty() ? "" : graph.workspaces.front().value;
    if (const auto* workspace = graph.find(arbiter);
        workspace != nullptr && runs(*workspace, "workspace")) {
      obey("link " + page + ".stop " + arbiter + ".stop");
      obey("link " + page + ".bid " + arbiter + ".person");
      obey("link " + arbiter + ".stopped " + page + ".stopped rate=20");
    }
  }
  obey("set " + page + ".browser=true");
  if (!listen.empty()) obey("set " + page + ".listen=" + listen);
}

std::vector<GraphPort> recorded_unlinked(const Graph& graph, const Describe& describe) {
  std::vector<GraphPort> outputs;
  for (const auto& module : graph.modules) {
    if (module.program.value.empty()) continue;
    const auto text = describe(module.program.value, module.host.value);
    const auto description = text ? parse_description(*text) : std::nullopt;
    if (!description) continue;
    if (find_output(*description, kTracePort) == &trace_output())
      outputs.push_back({module.name, kTracePort, ""});
    if (is_last(graph, module.name))
      for (const auto& output : description->outputs)
        outputs.push_back({module.name, output.name, ""});
  }
  return outputs;
}

std::vector<std::string> add_recorder(Graph& graph, const std::vector<GraphPort>& unlinked,
                                      const std::string& program,
                                      const std::map<std::string, std::string>& parameters) {
  // A folder gets all messages; but modules on other hosts never wait for the network.
  const bool is_whole = parameters.contains("folder");
  constexpr const char* kKept = "1024";   // messages, while the recorder waits for the disk
  constexpr const char* kPatience = "1";  // if the recorder hangs or was killed [s]
  GraphModule recorder;
  recorder.name = "recorder";
  while (graph.find(recorder.name) != nullptr) recorder.name += "_added";
  recorder.program.value = program;
  recorder.is_recorder = true;
  for (const auto& [name, value] : parameters) recorder.parameters[name] = {value, {}};
  std::vector<std::string> inputs;
  std::string streams;
  for (const auto& [output, place] : recorded_outputs(graph, unlinked)) {
    GraphLink link;
    link.from = {output.first, output.second, ""};
    link.to = {recorder.name, "stream_" + std::to_string(inputs.size()), ""};
    link.place = place;
    const auto* writer = graph.find(output.first);
    const bool is_here = writer == nullptr || writer->host.value.empty();
    link.policy["keep"] = {is_whole && is_here ? "all" : kKept, {}};
    if (is_whole && is_here) link.policy["timeout"] = {kPatience, {}};
    streams += (streams.empty() ? "" : " ") + link.to.port + "=" + link.from.text();
    inputs.push_back(link.to.port);
    graph.links.push_back(std::move(link));
  }
  recorder.parameters["streams"] = {streams, {}};
  graph.modules.push_back(std::move(recorder));
  return inputs;
}

Result<std::string> with_inputs(const std::string& text, const std::vector<std::string>& inputs) {
  auto description = parse_description(text);
  if (!description) return text;
  for (const auto& name : inputs) description->inputs.push_back({name, "a stream", {}, false});
  return to_json(*description);
}

}  // namespace hc
