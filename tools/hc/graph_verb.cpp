// SPDX-License-Identifier: Apache-2.0
// hc graph: draws a graph, and changes one that runs.
#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

#include "common.h"
#include "drawing.h"
#include "graph.h"
#include "observer.h"
#include "verbs.h"

namespace tool {
namespace {

struct Options {
  GraphOptions file;
  std::string running;  ///< --of
  std::string svg;
  bool as_dot = false;
};

/// Has Graphviz make a picture.
void write_svg(const std::string& dot, const std::string& path) {
  if (find_program("dot").empty())
    throw Failure(hc::Error{hc::Code::NotFound, "dot is not there; install graphviz"});
  // The file's name is no part of the command, whatever letters it has.
  ::setenv("HC_SVG", path.c_str(), 1);
  FILE* pipe = ::popen("dot -Tsvg -o \"$HC_SVG\"", "we");
  if (pipe == nullptr) throw Failure(hc::Error{hc::Code::System, "dot cannot be started"});
  std::fwrite(dot.data(), 1, dot.size(), pipe);
  if (int status = ::pclose(pipe); status != 0)
    throw Failure(hc::Error{hc::Code::System, fmt::format("dot failed: {} not written", path)});
}

void draw(const Options& options) {
  auto drawing = [&] {
    if (!options.file.file.empty())
      return drawing_of(*make_plan("graph", options.file, hc::graph_token()).plan,
                        options.file.file);
    auto graph = choose_running(options.running);
    auto state = Observer(graph).next_measured();
    if (!state) throw Failure(hc::Error{hc::Code::Closed, graph.text() + " has ended"});
    return drawing_of(*state);
  }();
  if (!options.svg.empty())
    write_svg(as_dot(drawing), options.svg);
  else
    print(options.as_dot ? as_dot(drawing) : as_text(drawing, ::isatty(STDOUT_FILENO) == 0));
}

struct Word {
  std::string name, doc;
};

/// A verb of `hc graph` whose words go to the running graph as they are.
/// @param more_words  of which there may be any number; without a name: there are none.
void add_change(CLI::App& verb, Options& options, const std::string& name, const std::string& doc,
                const std::vector<Word>& words, const Word& more_words = {}) {
  auto given = std::make_shared<std::vector<std::string>>(words.size());
  auto more = std::make_shared<std::vector<std::string>>();
  auto* change = verb.add_subcommand(name, doc);
  change->fallthrough();  // --of may stand behind it
  for (std::size_t i = 0; i < words.size(); ++i)
    change->add_option(words[i].name, (*given)[i], words[i].doc)->required();
  if (!more_words.name.empty()) change->add_option(more_words.name, *more, more_words.doc);
  change->callback([&options, name, given, more] {
    std::string command = name;
    for (const auto* list : {given.get(), more.get()})
      for (const auto& word : *list) command += " " + word;
    if (command.find('\n') != std::string::npos)
      throw Failure(hc::Error{hc::Code::Invalid, "a command is one line"});
    ask(choose_running(options.running), {command});
  });
}

}  // namespace

void add_graph(CLI::App& app) {
  static Options options;  // lives as long as the verbs that refer to it
  auto* verb = app.add_subcommand("graph", "Draw a graph, or change one that runs");
  verb->add_option("graph", options.file.file, "a graph file; otherwise the graph that runs");
  verb->add_option("--set", options.file.settings, "MODULE.PARAMETER=VALUE; may be repeated");
  verb->add_option("--of", options.running, "which running graph, where there are several (hc ps)");
  verb->add_option("--svg", options.svg, "write a picture to this file, by Graphviz");
  verb->add_flag("--dot", options.as_dot, "print the drawing in Graphviz's language");
  const Word module = {"MODULE", "its name in the graph"};
  const Word from = {"FROM", "an output, MODULE.PORT, or a URI of the world outside"};
  const Word to = {"TO", "an input, MODULE.PORT, or a URI of the world outside"};
  add_change(*verb, options, "add", "Start another module",
             {{"MODULE", "a name that no module of the graph has"},
              {"PROGRAM", "what it runs: a module's name, or the path of a program"}},
             {"PARAMETER=VALUE", "values of its parameters; otherwise the defaults"});
  add_change(*verb, options, "remove", "End a module, and take its links away", {module});
  add_change(*verb, options, "restart", "End a module, and start it again", {module});
  add_change(*verb, options, "link", "Add a link, or give one another policy", {from, to},
             {"KEY=VALUE", "its policy: keep, rate, burst, memory"});
  add_change(*verb, options, "unlink", "Take a link away", {from, to});
  add_change(*verb, options, "set", "Set a parameter",
             {{"MODULE.PARAMETER=VALUE", "which parameter, and its new value"}});
  add_change(*verb, options, "stop", "End the graph", {});
  verb->callback([verb] {
    if (verb->get_subcommands().empty()) draw(options);
  });
}

}  // namespace tool
