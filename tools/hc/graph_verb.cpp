// SPDX-License-Identifier: Apache-2.0
// hc graph: draws a graph, and inspects and changes a running one.
#include <sys/epoll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <optional>

#include <hc/base/format.h>
#include <hc/base/suggestion.h>
#include <hc/contract/description.h>
#include <hc/os/program.h>

#include "common.h"
#include "drawing.h"
#include "graph.h"
#include "observer.h"
#include "verbs.h"
#include "words.h"

namespace tool {
namespace {

struct GraphOptions {
  hc::LoadOptions file;
  std::string running;  ///< --of
  std::string svg;
  bool as_dot = false;
};

/// Makes an image with Graphviz.
void write_svg(const std::string& dot, const std::string& path) {
  if (find_program("dot").empty())
    throw Failure(hc::Code::NotFound, "dot is not installed; install graphviz");
  // Passed in the environment, so that no character of the path needs quoting.
  ::setenv("HC_SVG", path.c_str(), 1);
  FILE* pipe = ::popen("dot -Tsvg -o \"$HC_SVG\"", "we");
  if (pipe == nullptr) throw Failure(hc::Code::System, "dot cannot be started");
  std::fwrite(dot.data(), 1, dot.size(), pipe);
  if (int status = ::pclose(pipe); status != 0)
    throw Failure(hc::Code::System, hc::format("dot failed: {} not written", path));
}

void draw(const GraphOptions& options) {
  auto drawing = [&] {
    if (!options.file.file.empty())
      return drawing_of(look_at_plan("graph", options.file), options.file.file);
    return drawing_of(state_of(choose_running(options.running), true));
  }();
  if (!options.svg.empty())
    write_svg(as_dot(drawing), options.svg);
  else
    print(options.as_dot ? as_dot(drawing) : as_text(drawing, ::isatty(STDOUT_FILENO) == 0));
}

/// The parameters in a module's description, sorted by name; empty without a description.
std::vector<hc::ParameterState> parameters_of(const RunningGraph& graph,
                                              const hc::ModuleState& module) {
  const auto answer = command_graph(graph, {"describe " + module.name});
  auto description = hc::parse_description(answer.empty() ? "" : answer.front());
  if (!description) return {};
  for (auto& parameter : description->parameters)
    parameter.options.fixed = parameter.options.fixed || !description->control;
  std::ranges::sort(description->parameters, {}, &hc::ParameterState::name);
  return std::move(description->parameters);
}

/// Adds a row for each parameter: its value, and its range and default.
/// @param what  MODULE, MODULE.PARAMETER, or empty: all.
void add_parameters(const RunningGraph& graph, const hc::GraphState& state, const std::string& what,
                    std::vector<std::array<std::string, 2>>& rows) {
  const auto dot = std::min(what.find('.'), what.size());
  const std::string wanted = dot < what.size() ? what.substr(dot + 1) : "";
  auto add = [&](const hc::ModuleState& module) {
    const auto parameters = parameters_of(graph, module);
    if (!wanted.empty() && hc::find_named(parameters, wanted) == nullptr)
      throw Failure(hc::Code::Invalid,
                    hc::format("module {} has no parameter \"{}\"{}", module.name, wanted,
                               hc::suggestion(wanted, hc::names_of(parameters))));
    for (const auto& parameter : parameters) {
      const auto& name = parameter.name;
      const auto& options = parameter.options;
      if (!wanted.empty() && name != wanted) continue;
      const auto found = module.parameters.find(name);
      const std::string now =
          found == module.parameters.end() ? hc::text(parameter.default_value) : found->second;
      const auto range =
          options.choices.empty() ? hc::range_in_words(options) : joined(options.choices, " or ");
      const auto default_text = hc::text(parameter.default_value);
      rows.push_back({hc::format("{}.{} = {}{}", module.name, name, now,
                                 parameter.unit.empty() ? "" : " " + parameter.unit),
                      hc::format("{}default {}{}", range.empty() ? "" : range + ", ",
                                 default_text.empty() ? "\"\"" : default_text,
                                 options.fixed ? ", set restarts the module" : "")});
    }
  };
  if (!what.empty()) add(find_module(state, what.substr(0, dot)));
  for (const auto& module : state.modules)
    if (what.empty()) add(module);
}

/// Prints parameters. @param wanted  as `what` of add_parameters().
void get(const RunningGraph& graph, const std::vector<std::string>& wanted) {
  const auto state = state_of(graph);
  std::vector<std::array<std::string, 2>> rows;
  for (const auto& what : wanted) add_parameters(graph, state, what, rows);
  if (wanted.empty()) add_parameters(graph, state, "", rows);
  constexpr std::size_t kMaxColumn = 60;
  std::size_t widest = 0;
  for (const auto& row : rows) widest = std::max(widest, row[0].size());
  std::string text;
  for (const auto& [value, about] : rows)
    text += hc::format("{:<{}}  ({})\n", value, std::min(widest, kMaxColumn), about);
  print(text);
}

/// Sends commands to the graph, which executes all or none.
void change(const GraphOptions& options, const std::vector<std::string>& commands) {
  for (const auto& command : commands)
    if (command.find('\n') != std::string::npos)
      throw Failure(hc::Code::Invalid, "a command must be one line");
  for (const auto& remark : command_graph(choose_running(options.running), commands))
    say("hc graph: " + remark);
}

/// Adds a link and, if it leads to the outside, waits until its module has opened it. If that
/// fails, removes it and fails.
/// @param command  "link FROM TO …"
void link(const RunningGraph& graph, const std::string& from, const std::string& to,
          const std::string& command) {
  constexpr std::chrono::seconds kPatience{5};
  const bool is_inside = hc::is_port_name(from) && hc::is_port_name(to);
  const std::string& port = hc::is_port_name(from) ? from : to;
  const auto module = port.substr(0, port.find('.'));
  const auto loop = value_or_fail(hc::Loop::make());
  hc::GraphClient client(*loop, graph);
  std::optional<std::string> failure;  // "": it is open
  bool is_answered = false, is_accepted = false;
  auto take_state = [&](const hc::GraphState& state, auto) {
    for (const auto& each : state.links)
      if (is_accepted && !failure && each.from == from && each.to == to &&
          (each.status.empty() || each.status == hc::kNotConnected))
        failure.emplace();
  };
  auto take_log = [&](const hc::LogLine& line, auto) {
    if (line.module != module || failure) return;
    if (line.text.starts_with("command \"link "))
      failure = line.text.substr(line.text.find("\": ") + 3);
    // A file that cannot be written ends no module.
    if (line.level == hc::Level::Error &&
        line.text.find(to.substr(to.find(':') + 1)) != std::string::npos)
      failure = line.text;
  };
  auto end = [&] { failure = "the graph has ended"; };
  if (const auto watched = client.watch({take_state, take_log, end}); !watched)
    throw Failure(watched.error());
  client.command({command}, [&](const hc::Result<hc::GraphAnswer>& answer) {
    is_answered = true;
    is_accepted = answer && answer->is_ok;
    if (!answer) failure = answer.error().detail;
    if (answer && !is_accepted) failure = joined(answer->rows, "\n");
    if (is_accepted && is_inside && !failure) failure.emplace();
  });
  const auto late = loop->call_at(std::chrono::steady_clock::now() + kPatience, [&] {
    if (is_accepted) failure = module + " has not opened the link within 5 s";
  });
  const auto stopped = value_or_fail(loop->watch(hc::stop_descriptor(), EPOLLIN, [&](auto) {
    is_answered = true;
    failure = "interrupted";
  }));
  while (!failure || !is_answered)
    if (const auto turned = loop->turn(); !turned) throw Failure(turned.error());
  if (failure->empty()) return;
  if (is_accepted) static_cast<void>(hc::ask(graph, {"unlink " + from + " " + to}));
  throw Failure(hc::Code::Invalid, *failure);
}

struct Word {
  std::string name, doc;
};

/// Adds a verb of `hc graph` for a running graph, which excludes the options for drawing.
CLI::App* add_verb(CLI::App& verb, GraphOptions& options, const std::string& name,
                   const std::string& doc) {
  auto* added = verb.add_subcommand(name, doc);
  add_of(*added, options.running);
  for (const char* drawn : {"graph", "--set", "--svg", "--dot"})
    added->excludes(verb.get_option(drawn));
  return added;
}

/// A program's path, which here is relative to the present folder, and in a graph file to its own.
/// @param module  MODULE or MODULE@HOST, where the path is the host's.
std::string program_path(const std::string& module, const std::string& program) {
  const bool is_path = program.find('/') != std::string::npos;
  if (!is_path || module.find('@') != std::string::npos) return program;
  return std::filesystem::absolute(program).lexically_normal().string();
}

/// Adds a verb that sends its words to the running graph: as one command or, with `is_each`, as a
/// command for each of `more_words`, of which all or none are executed.
/// @param more_words  any number of further words; without a name: none.
/// @param is_link  the words are ends of a link.
void add_change(CLI::App& verb, GraphOptions& options, const std::string& name,
                const std::string& doc, const std::vector<Word>& words, const Word& more_words = {},
                bool is_each = false, bool is_link = false) {
  auto given = std::make_shared<std::vector<std::string>>(words.size());
  auto more = std::make_shared<std::vector<std::string>>();
  auto* added = add_verb(verb, options, name, doc);
  for (std::size_t i = 0; i < words.size(); ++i)
    added->add_option(words[i].name, (*given)[i], words[i].doc)->required();
  if (!more_words.name.empty())
    added->add_option(more_words.name, *more, more_words.doc)->required(is_each);
  added->callback([&options, name, given, more, is_each, is_link] {
    for (auto& word : *given)
      if (is_link) word = link_end(word);
    if (name == "add") (*given)[1] = program_path((*given)[0], (*given)[1]);
    std::vector<std::string> commands;
    for (const auto& word : *more)
      if (is_each) commands.push_back(name + " " + word);
    if (is_each) return change(options, commands);
    std::vector<std::string> line = {name};
    for (const auto* list : {given.get(), more.get()})
      line.insert(line.end(), list->begin(), list->end());
    if (name == "link")
      return link(choose_running(options.running), line[1], line[2], joined(line, " "));
    change(options, {joined(line, " ")});
  });
}

}  // namespace

void add_graph(CLI::App& app) {
  static GraphOptions options;  // referenced by all verbs
  auto* verb = app.add_subcommand("graph", "Draw a graph, or inspect and change a running one");
  verb->add_option("graph", options.file.file,
                   "a graph file, or the name of a shipped one (default: the running graph)")
      ->transform(find_graph);
  verb->add_option("--set", options.file.settings, "MODULE.PARAMETER=VALUE; may be repeated")
      ->allow_extra_args(false);
  add_of(*verb, options.running);
  verb->add_option("--svg", options.svg, "write an SVG image to this file (needs Graphviz)");
  verb->add_flag("--dot", options.as_dot, "print the drawing in the DOT language of Graphviz");
  const Word module = {"MODULE", "its name in the graph; there may be several"};
  const Word from = {"FROM", "an output MODULE.PORT, a URI, or a file"};
  const Word to = {"TO", "an input MODULE.PORT, a URI, or a file"};
  add_change(*verb, options, "add", "Add a module",
             {{"MODULE", "its name, new in the graph"},
              {"PROGRAM", "a module's program, or the path of any program"}},
             {"SETTING", "a parameter, as PARAMETER=VALUE (default: its own default)"});
  add_change(*verb, options, "remove", "Stop and remove modules, and their links", {}, module,
             true);
  add_change(*verb, options, "restart", "Restart modules", {}, module, true);
  add_change(*verb, options, "link", "Add a link, or change its policy", {from, to},
             {"POLICY",
              "a setting of the policy, as KEY=VALUE: keep, rate, burst, memory, timeout, as, "
              "quality, scale"},
             false, true);
  add_change(*verb, options, "unlink", "Remove a link", {from, to}, {}, false, true);
  add_change(*verb, options, "set", "Set parameters, all or none", {},
             {"SETTING", "a parameter and its new value, as MODULE.PARAMETER=VALUE"}, true);
  add_change(*verb, options, "stop", "End the graph", {});
  auto wanted = std::make_shared<std::vector<std::string>>();
  auto* getter = add_verb(*verb, options, "get", "Print parameters: value, unit, range, default");
  getter->add_option("MODULE[.PARAMETER]", *wanted, "a module or a parameter (default: all)");
  getter->callback([wanted] { get(choose_running(options.running), *wanted); });
  verb->callback([verb] {
    if (verb->get_subcommands().empty()) draw(options);
  });
}

}  // namespace tool
