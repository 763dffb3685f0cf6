// SPDX-License-Identifier: Apache-2.0
#include <hc/graph/graph_file.h>

#include <algorithm>
#include <filesystem>

#include <hc/base/suggestion.h>
#include <hc/graph/file/tables.h>

namespace hc {
namespace {

using internal::Node;
using internal::quoted_name;

constexpr std::size_t kMaxIncludedDepth = 16;                  // of files that include files
constexpr std::size_t kMaxIncludedBytes = 4 * kMaxGraphBytes;  // of all that is included

std::vector<std::string> names_of(const Graph& graph) {
  std::vector<std::string> names;
  for (const auto& module : graph.modules) names.push_back(module.name);
  return names;
}

/// Reads a file and those that it includes, and goes on behind what is wrong.
class GraphReader {
 public:
  GraphReader(const Environment& environment, Problems& problems, const ReadFile& read_file)
      : fields_(environment, problems), problems_(problems), read_file_(read_file) {}

  Graph read(std::string_view text, int file) {
    Graph graph;
    graph.file = problems_.file(file);
    auto root = internal::read_document(text, file, problems_);
    if (!root) return graph;
    fields_.check_keys(
        *root, {"modules", "links", "restart", "groups", "modes", "workspace", "frames", "graphs"},
        "at the top of a graph");
    Restart restart = internal::read_restart(fields_, *root, Restart::Failure);
    internal::read_modules(fields_, *root, restart, graph);
    internal::read_links(fields_, *root, graph);
    internal::read_groups(fields_, *root, graph);
    internal::read_modes(fields_, *root, graph);
    internal::read_workspace(fields_, *root, graph);
    internal::read_frames(fields_, *root, graph);
    within_.push_back(std::filesystem::path(graph.file).lexically_normal().string());
    fields_.each(*root, "graphs",
                 [&](const std::string& name, const Node& node) { include(graph, name, node); });
    within_.pop_back();
    if (within_.empty() && graph.modules.size() > kMaxModules)
      problems_.add(graph.modules[kMaxModules].place,
                    "a graph has at most " + std::to_string(kMaxModules) + " modules");
    const std::size_t most = within_.empty() ? kMaxModules : kMaxModules + 1;
    if (graph.modules.size() > most) graph.modules.resize(most);
    return graph;
  }

 private:
  void include(Graph& graph, const std::string& name, const Node& node) {
    if (!internal::is_name(name))
      fields_.add(node, "a graph's name is snake_case, not " + quoted_name(name));
    if (node.table() == nullptr)
      return fields_.add(node, "a graph is a table [graphs." + name + "]");
    fields_.check_keys(node, {"file", "parameters"}, "in graph " + name);
    auto file = fields_.text(node, "file");
    if (!file) return;
    auto text = read_included(graph.file, *file);
    if (!text) return;
    Graph included = internal::with_prefix(
        read(*text, problems_.add_file(path_of(graph.file, file->value))), name);
    set_parameters(included, name, node);
    for (const auto& module : included.modules)
      if (internal::is_name(name) && !internal::is_name(module.name) && module.name.size() > 64)
        fields_.add(node, "the name " + module.name + " has more than 64 letters");
    internal::append(graph, std::move(included), problems_);
  }

  static std::string path_of(const std::string& from, const std::string& file) {
    return (std::filesystem::path(from).parent_path() / file).lexically_normal().string();
  }

  std::optional<std::string> read_included(const std::string& from,
                                           const Lined<std::string>& file) {
    const std::string path = path_of(from, file.value);
    auto refuse = [&](const std::string& what) {
      problems_.add(file.place, what);
      return std::nullopt;
    };
    if (std::find(within_.begin(), within_.end(), path) != within_.end())
      return refuse(path + " includes itself");
    if (within_.size() > kMaxIncludedDepth)
      return refuse("at most " + std::to_string(kMaxIncludedDepth) + " files stand in one another");
    if (++included_ > kMaxIncluded) {
      if (included_ > kMaxIncluded + 1) return std::nullopt;  // it has been told
      return refuse("at most " + std::to_string(kMaxIncluded) + " files are included");
    }
    Result<std::string> text = Error{Code::NotFound, path + ": cannot be read"};
    if (read_file_) text = read_file_(path);
    if (!text) return refuse(text.error().detail);
    included_bytes_ += text->size();
    if (included_bytes_ > kMaxIncludedBytes)
      return refuse("all that is included has at most " + std::to_string(kMaxIncludedBytes) +
                    " bytes");
    return std::move(*text);
  }

  /// `parameters.MODULE.NAME` over what the included graph says.
  void set_parameters(Graph& included, const std::string& prefix, const Node& node) {
    fields_.each(node, "parameters", [&](const std::string& name, const Node& values) {
      GraphModule* module = included.find(prefix + "_" + name);
      if (module == nullptr) {
        auto known = names_of(included);
        for (auto& each : known) each.erase(0, prefix.size() + 1);
        return fields_.add(values, "graph " + prefix + " has no module " + quoted_name(name) +
                                       suggestion(name, known));
      }
      fields_.each(*node.find("parameters"), name, [&](const std::string& key, const Node& value) {
        if (auto text = fields_.parameter(value)) module->parameters[key] = {*text, value.place};
      });
    });
  }

  internal::Fields fields_;
  Problems& problems_;
  const ReadFile& read_file_;
  std::vector<std::string> within_;  // the files that are being read, each in the one before
  int included_ = 0;
  std::size_t included_bytes_ = 0;
};

}  // namespace

GraphModule* Graph::find(std::string_view name) {
  auto found = std::find_if(modules.begin(), modules.end(),
                            [&](const GraphModule& module) { return module.name == name; });
  return found == modules.end() ? nullptr : &*found;
}

Graph parse_graph(std::string_view text, const Environment& environment, Problems& problems,
                  const ReadFile& read_file) {
  return GraphReader(environment, problems, read_file).read(text, 0);
}

void record_outputs(Graph& graph, const std::string& folder) {
  std::map<std::pair<std::string, std::string>, Place> outputs;
  for (const auto& link : graph.links)
    if (link.from.uri.empty())
      outputs.emplace(std::pair(link.from.module, link.from.port), link.place);
  if (graph.workspace && !graph.workspace->value.empty())
    outputs.emplace(std::pair(graph.workspace->value, "focus"), graph.workspace->place);
  for (const auto& [output, place] : outputs) {
    GraphLink link;
    link.from = {output.first, output.second, ""};
    link.to.uri = "file:" + folder + "/" + link.from.text() + ".mtp";
    link.place = place;
    graph.links.push_back(std::move(link));
  }
}

void set_parameter(Graph& graph, std::string_view assignment, Problems& problems) {
  auto dot = assignment.find('.'), equals = assignment.find('=');
  if (dot == std::string_view::npos || equals == std::string_view::npos || dot > equals)
    return problems.add({}, quoted_name(assignment) + " is not MODULE.PARAMETER=VALUE");
  std::string name{assignment.substr(0, dot)};
  GraphModule* module = graph.find(name);
  if (module == nullptr && graph.modules.empty() && !problems.empty()) return;  // nothing was read
  if (module == nullptr)
    return problems.add({}, "no module " + quoted_name(name) + " in " + graph.file +
                                suggestion(name, names_of(graph)));
  module->parameters[std::string(assignment.substr(dot + 1, equals - dot - 1))] = {
      std::string(assignment.substr(equals + 1)), {}};
}

}  // namespace hc
