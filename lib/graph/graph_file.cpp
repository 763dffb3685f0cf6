// SPDX-License-Identifier: Apache-2.0
#include <graph/graph_file.h>

#include <algorithm>
#include <filesystem>

#include <graph/file/tables.h>
#include <graph/programs.h>
#include <hc/base/suggestion.h>
#include <hc/contract/conversion.h>
#include <hc/contract/description.h>
#include <hc/link/policy.h>

namespace hc {
namespace {

using internal::Node;

constexpr std::size_t kMaxIncludedDepth = 16;
constexpr std::size_t kMaxIncludedBytes = 4 * kMaxGraphBytes;  // of all included files

/// Reads a file and the files it includes; continues after problems.
class GraphReader {
 public:
  GraphReader(const Environment& environment, Problems& problems, const ReadFile& read_file)
      : fields_(problems), environment_(environment), problems_(problems), read_file_(read_file) {}

  Graph read(std::string_view text, int file) {
    Graph graph;
    graph.file = problems_.file(file);
    auto root = internal::read_document(text, file, environment_, problems_);
    if (!root || !check_version(*root)) return graph;
    including_.push_back(std::filesystem::path(graph.file).lexically_normal().string());
    Restart restart = Restart::Failure;
    Lined<std::int64_t> timeout, hang;
    const std::size_t before = problems_.size();
    fields_.read(*root, "at the top of the file",
                 {{"version", [](const Node&) {}},
                  {"restart", internal::read_restart(fields_, restart)},
                  {"timeout", fields_.integer(timeout, 0, internal::kMaxSeconds)},
                  {"hang", fields_.integer(hang, 0, internal::kMaxSeconds)},
                  {"modules", fields_.each([&](const Node& node) { add_module(graph, node); })},
                  {"hosts", internal::read_hosts(fields_, graph)},
                  {"modes", internal::read_modes(fields_, graph)},
                  {"workspace", internal::read_workspace(fields_, graph)},
                  {"frames", internal::read_frames(fields_, graph)},
                  {"graphs", [](const Node&) {}}});
    const bool has_modules = root->find("modules") != nullptr || root->find("graphs") != nullptr;
    if (!has_modules && problems_.size() == before)
      fields_.add(*root, "a graph needs a table [modules.NAME] for each of its modules");
    for (auto& each : graph.modules) {  // defaults
      if (root->find("modules")->find(each.name)->find("restart") == nullptr)
        each.restart = restart;
      if (each.hang.place.line == 0) each.hang = hang;
    }
    if (timeout.place.line != 0)
      for (auto& link : graph.links)
        if (link.from.uri.empty())
          link.policy.try_emplace("timeout",
                                  Lined<std::string>{std::to_string(timeout.value), timeout.place});
    if (const Node* graphs = root->find("graphs"))
      fields_.each([&](const Node& node) { include(graph, node); })(*graphs);
    including_.pop_back();
    if (root->find("workspace") != nullptr)
      for (auto& each : graph.modules)
        if (each.workspace.empty()) each.workspace = graph.workspaces.front().value;
    limit(graph);
    return graph;
  }

 private:
  bool check_version(const Node& root) {
    const Node* version = root.find("version");
    const auto* number = version == nullptr ? nullptr : version->as<std::int64_t>();
    if (number != nullptr && *number == kGraphVersion) return true;
    const std::string known = "version = " + std::to_string(kGraphVersion);
    if (version == nullptr)
      fields_.add(root, "a graph file begins with \"" + known + "\"");
    else if (number != nullptr && *number > kGraphVersion)
      fields_.add(*version, "this file has version {}, and this hc reads version {}: update hc",
                  *number, kGraphVersion);
    else
      fields_.add(*version, "a graph file has \"" + known + "\"");
    return false;
  }

  void add_module(Graph& graph, const Node& node) {
    GraphModule& module = graph.modules.emplace_back();
    module.name = node.key;
    module.place = node.place;
    if (fields_.check_name(node, "module", node.key) && node.find("program") == nullptr)
      module.program = {node.key, node.place};
    internal::read_module(fields_, node, node.key, graph);
  }

  void limit(Graph& graph) {
    if (including_.empty() && graph.modules.size() > kMaxModules)
      problems_.add(graph.modules[kMaxModules].place, "a graph has at most {} modules",
                    kMaxModules);
    const std::size_t most = including_.empty() ? kMaxModules : kMaxModules + 1;
    if (graph.modules.size() > most) graph.modules.resize(most);
  }

  void include(Graph& graph, const Node& node) {
    const std::string& name = node.key;
    Lined<std::string> file, host;
    const Node* overrides = nullptr;
    fields_.check_name(node, "graph", name);
    fields_.read(node, "in graph " + name,
                 {{"file", fields_.text(file), true},
                  {"host", fields_.any_text(host)},
                  {"modules", [&](const Node& modules) { overrides = &modules; }}});
    if (file.value.empty()) return;
    const auto found = read_included(graph.file, file);
    if (!found) {
      graph.is_whole = false;
      return;
    }
    Graph included =
        internal::with_prefix(read(found->text, problems_.add_file(found->path)), name);
    for (auto& module : included.modules)
      if (module.host.place.line == 0) module.host = host;
    if (overrides != nullptr)
      fields_.each([&](const Node& module) { override_module(included, name, module); })(
          *overrides);
    for (const auto& module : included.modules)
      if (is_name(name) && !is_name(module.name) && module.name.size() > 64)
        fields_.add(node, "the name {} has more than 64 letters", module.name);
    internal::append(graph, std::move(included), problems_);
  }

  void override_module(Graph& included, const std::string& prefix, const Node& node) {
    const std::string name = prefix + "_" + node.key;
    if (included.find(name) != nullptr) return internal::read_module(fields_, node, name, included);
    if (included.modules.empty() && !problems_.empty()) return;  // unreadable file
    auto known = names_of(included.modules);
    for (auto& each : known) each.erase(0, prefix.size() + 1);
    fields_.add(node, "graph {} has no module \"{}\"{}", prefix, node.key,
                suggestion(node.key, known));
  }

  struct Included {
    std::string path, text;
  };

  /// Reads a file by its path relative to the including file, or a shipped one by its name.
  std::optional<Included> read_included(const std::string& from, const Lined<std::string>& file) {
    std::string path = (std::filesystem::path(from).parent_path() / file.value).lexically_normal();
    auto refuse = [&](const std::string& what) {
      problems_.add(file.place, what);
      return std::nullopt;
    };
    auto includes_itself = [&] { return std::ranges::find(including_, path) != including_.end(); };
    if (includes_itself()) return refuse(path + " includes itself");
    if (including_.size() > kMaxIncludedDepth)
      return refuse("at most " + std::to_string(kMaxIncludedDepth) + " nested includes");
    if (++included_ > kMaxIncluded) {
      if (included_ > kMaxIncluded + 1) return std::nullopt;  // already reported
      return refuse("at most " + std::to_string(kMaxIncluded) + " files are included");
    }
    Result<std::string> text = Error{Code::NotFound, path + ": cannot be read"};
    if (read_file_) text = read_file_(path);
    if (!text && text.error().code == Code::NotFound && file.value.find('/') == std::string::npos) {
      const std::string shipped = graph_folder() / file.value;
      auto found = read_file_ ? read_file_(shipped) : text;
      if (found || found.error().code != Code::NotFound) {
        path = shipped;
        text = std::move(found);
        if (includes_itself()) return refuse(path + " includes itself");
      }
    }
    if (!text) return refuse(text.error().detail);
    included_bytes_ += text->size();
    if (included_bytes_ > kMaxIncludedBytes)
      return refuse("all included files together have at most " +
                    std::to_string(kMaxIncludedBytes) + " bytes");
    return Included{std::move(path), std::move(*text)};
  }

  internal::Fields fields_;
  const Environment& environment_;
  Problems& problems_;
  const ReadFile& read_file_;
  std::vector<std::string> including_;  // the stack of files being read
  int included_ = 0;
  std::size_t included_bytes_ = 0;
};

}  // namespace

GraphModule* Graph::find(std::string_view name) {
  auto found = std::find_if(modules.begin(), modules.end(),
                            [&](const GraphModule& module) { return module.name == name; });
  return found == modules.end() ? nullptr : &*found;
}

Status check_policy(Uri policy) {
  HC_TRY(take_conversion(policy));
  auto valid = internal::parse_policy(policy);
  return valid ? Status() : valid.error();
}

Graph parse_graph(std::string_view text, const Environment& environment, Problems& problems,
                  const ReadFile& read_file) {
  Graph graph = GraphReader(environment, problems, read_file).read(text, 0);
  graph.files = problems.files();
  // Any file may declare a host, so check when all have been read.
  for (const auto& module : graph.modules)
    if (const auto& [host, place] = module.host;
        !host.empty() && find_named(graph.hosts, host) == nullptr)
      problems.add(place, "no host \"{}\"{}", host, suggestion(host, names_of(graph.hosts)));
  return graph;
}

void set_parameter(Graph& graph, const Assignment& assignment, Problems& problems,
                   const Place& place) {
  GraphModule* module = graph.find(assignment.module);
  if (module == nullptr && graph.modules.empty() && !problems.empty()) return;  // unreadable file
  if (module == nullptr)
    return problems.add(place, "no module \"{}\" in {}{}", assignment.module, graph.file,
                        suggestion(assignment.module, names_of(graph.modules)));
  module->parameters[assignment.parameter] = {assignment.value, place};
}

}  // namespace hc
