// SPDX-License-Identifier: Apache-2.0
#include "graph.h"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <map>

#include <hc/base/suggestion.h>
#include <hc/graph/commands.h>
#include <hc/graph/run.h>

#include "common.h"

namespace tool {
namespace {

bool is_folder(const std::string& name) {
  std::error_code missing;
  return std::filesystem::is_directory(name, missing);
}

hc::Result<std::string> read_text(const std::string& name) {
  if (is_folder(name)) return hc::Error{hc::Code::NotFound, name + ": is a folder, not a file"};
  std::ifstream file(name, std::ios::binary);
  if (!file) return hc::Error{hc::Code::NotFound, name + ": cannot be read"};
  std::string text(hc::kMaxGraphBytes + 1, '\0');
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(file.gcount()));
  return text;
}

/// What is included is a file, so that nothing is waited for.
hc::Result<std::string> read_included(const std::string& name) {
  std::error_code missing;
  if (!std::filesystem::is_regular_file(name, missing) && !is_folder(name))
    return hc::Error{hc::Code::NotFound, name + ": cannot be read"};
  return read_text(name);
}

hc::Result<std::string> read_once(const std::string& name, Texts& texts, const hc::ReadFile& read) {
  if (auto known = texts.find(name); known != texts.end()) return known->second;
  auto text = read(name);
  if (text) texts[name] = *text;
  return text;
}

/// @param path  what `program` stands for, where it has a slash.
std::string why_no_program(const std::string& program, const std::string& path) {
  std::error_code missing;
  if (path.find('/') == std::string::npos)
    return fmt::format("no program \"{}\"{}", program, hc::suggestion(program, module_names()));
  if (is_folder(path)) return path + " is a folder, not a program";
  if (std::filesystem::exists(path, missing)) return path + " may not be executed";
  return fmt::format("no program \"{}\"", program);
}

/// Names of programs become paths; one with a slash is sought from the folder of the file where it
/// stands.
void resolve_programs(hc::Graph& graph, hc::Problems& problems) {
  for (auto& module : graph.modules) {
    auto& [given, place] = module.program;
    if (given.empty()) continue;  // what is wrong has been reported
    std::string name = given;
    if (name.find('/') != std::string::npos && !name.starts_with('/'))
      name = (std::filesystem::path(problems.file(place.file)).parent_path() / name).string();
    std::string program = find_program(name);
    if (program.empty()) problems.add(place, why_no_program(given, name));
    given = program;
  }
}

/// What a program says of itself. It is asked once, and again when its file is another: a graph
/// that is planned anew while it runs is not to wait for what is known.
hc::Result<std::string> describe_once(const std::string& program, int stop) {
  struct Known {
    std::filesystem::file_time_type time;
    std::uintmax_t size;
    std::string description;
  };
  static std::map<std::string, Known> all;
  std::error_code missing;
  const auto time = std::filesystem::last_write_time(program, missing);
  const auto size = std::filesystem::file_size(program, missing);
  auto known = all.find(program);
  if (!missing && known != all.end() && known->second.time == time && known->second.size == size)
    return known->second.description;
  auto description = hc::describe_program(program, stop);
  if (description && !missing) all[program] = {time, size, *description};
  return description;
}

}  // namespace

void add_graph_options(CLI::App& verb, GraphOptions& options) {
  verb.add_option("graph", options.file, "a graph file (TOML), or the name of a shipped one")
      ->required()
      ->transform(find_graph);
  verb.add_option("--set", options.settings, "MODULE.PARAMETER=VALUE; may be repeated");
}

hc::Result<hc::Replanned> plan_graph(const GraphOptions& options, const std::string& token,
                                     Texts& texts, const std::vector<std::string>& commands,
                                     const hc::Plan* before, int stop) {
  hc::Problems problems(options.file);
  auto environment = [](const char* name) -> const char* { return std::getenv(name); };
  // What a graph that runs is made of is a file, too: nobody need write into a pipe once more.
  auto text = read_once(options.file, texts, before == nullptr ? read_text : read_included);
  if (!text) return text.error();
  auto read = [&](const std::string& name) { return read_once(name, texts, read_included); };
  hc::Graph graph = hc::parse_graph(*text, environment, problems, read);
  for (const auto& setting : options.settings) hc::set_parameter(graph, setting, problems);
  for (const auto& line : commands)
    if (auto command = hc::parse_command(line)) hc::apply_command(graph, *command, problems);
  if (!options.record.empty()) hc::record_outputs(graph, options.record);
  resolve_programs(graph, problems);
  std::map<std::string, hc::Result<std::string>> described;
  auto describe = [&](const std::string& program) {
    auto known = described.find(program);
    if (known == described.end())
      known = described.emplace(program, describe_once(program, stop)).first;
    return known->second;
  };
  hc::Replanned planned;
  planned.plan = hc::make_plan(std::move(graph), describe, token, problems, before);
  planned.files = problems.files();
  for (auto& line : problems.lines()) {
    constexpr std::string_view kBeside = "--set: ";  // what is set beside a file that runs is asked
    const bool is_asked = !commands.empty() && line.starts_with(kBeside);
    planned.problems.push_back(is_asked ? line.substr(kBeside.size()) : std::move(line));
  }
  if (!problems.empty()) planned.plan.reset();
  return planned;
}

hc::Replanned make_plan(std::string_view verb, const GraphOptions& options,
                        const std::string& token) {
  Texts texts;
  return make_plan(verb, options, token, texts);
}

hc::Replanned make_plan(std::string_view verb, const GraphOptions& options,
                        const std::string& token, Texts& texts) {
  auto planned = plan_graph(options, token, texts);
  if (!planned) throw Failure(planned.error());
  if (planned->plan) return std::move(*planned);
  for (const auto& line : planned->problems) say(fmt::format("hc {}: error: {}", verb, line));
  throw Failure(2);
}

}  // namespace tool
