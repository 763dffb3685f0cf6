// SPDX-License-Identifier: Apache-2.0
// hc completion: prints scripts by which shells complete words, which ask `hc complete` for them.
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <map>
#include <set>
#include <utility>

#include <graph/programs.h>
#include <hc/base/format.h>
#include <hc/contract/description.h>

#include "common.h"
#include "observer.h"
#include "verbs.h"

namespace tool {
namespace {

using Words = std::vector<std::string>;

// Each shell asks `hc complete` for words, and adds the names of files.
constexpr const char* kBash = R"(# bash completion for hc: . <(hc completion bash)
_hc() {
  local word=${COMP_WORDS[COMP_CWORD]} found
  [ "$word" = "=" ] && word=
  found=$(hc complete -- "${COMP_WORDS[@]:1:COMP_CWORD}" 2>/dev/null)
  # shellcheck disable=SC2207 # words have no spaces
  COMPREPLY=($(compgen -W "$found" -- "$word") $(compgen -f -- "$word"))
  [[ ${COMPREPLY[0]} = *= ]] && compopt -o nospace 2>/dev/null
}
complete -o filenames -F _hc hc
)";
constexpr const char* kZsh = R"(#compdef hc
# zsh completion for hc: . <(hc completion zsh), after compinit; or a file _hc in $fpath
_hc() {
  local -a found open
  found=("${(@f)$(hc complete -- "${(@)words[2,CURRENT]}" 2>/dev/null)}")
  open=(${(M)found:#*=})
  found=(${found:#*=})
  compadd -S '' -a open
  compadd -a found
  _files
}
if [ "$funcstack[1]" = _hc ]; then _hc; else compdef _hc hc; fi
)";
constexpr const char* kFish = R"(# fish completion for hc: hc completion fish | source
complete -c hc -a '(hc complete -- (commandline -opc)[2..-1] (commandline -ct) 2>/dev/null)'
)";

void append(Words& words, const Words& more) {
  words.insert(words.end(), more.begin(), more.end());
}

const CLI::App* find_verb(const CLI::App& app, const std::string& name) {
  for (const auto* verb : app.get_subcommands([](const CLI::App*) { return true; }))
    if (verb->get_name() == name) return verb;
  return nullptr;
}

Words verbs_of(const CLI::App& app) {
  Words names;
  for (const auto* verb : app.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(verb->get_name());
  return names;
}

Words options_of(const CLI::App& verb) {
  Words names;
  for (const auto* option : verb.get_options())
    for (const auto& name : option->get_lnames()) names.push_back("--" + name);
  return names;
}

/// The options of a module: its parameters, and links.
Words options_of_module(const std::string& name) {
  Words words = {"--in", "--out", "--help"};
  const auto text = hc::describe_program(find_program(name));
  const auto description = hc::parse_description(text ? *text : "");
  if (!description) return words;
  for (const auto& parameter : description->parameters) words.push_back("--" + parameter.name);
  return words;
}

Words running_graphs() {
  std::map<std::string, int> count;
  const auto graphs = find_running();
  for (const auto& graph : graphs) ++count[graph.name];
  Words words;
  for (const auto& graph : graphs)
    words.push_back(count[graph.name] == 1 ? graph.name : graph.text());
  return words;
}

/// What a running graph has.
struct Running {
  Words modules, inputs, outputs, parameters, links;

  /// @param of  its name; empty: as choose_running().
  explicit Running(const std::string& of) {
    try {
      const auto graph = choose_running(of);
      const auto state = state_of(graph);
      for (const auto& module : state.modules) add(graph, module.name);
      for (const auto& link : state.links) append(links, {link.from, link.to});
    } catch (const std::exception&) {
      return;  // no graph, or several
    }
  }

 private:
  void add(const RunningGraph& graph, const std::string& module) {
    modules.push_back(module);
    const auto description =
        hc::parse_description(joined(command_graph(graph, {"describe " + module})));
    if (!description) return;
    for (const auto& port : description->inputs) inputs.push_back(module + "." + port.name);
    for (const auto& port : description->outputs) outputs.push_back(module + "." + port.name);
    for (const auto& parameter : description->parameters)
      parameters.push_back(module + "." + parameter.name);
  }
};

Words with_equals(Words words) {
  for (auto& word : words) word += "=";
  return words;
}

/// Removes `--of NAME` or `--of=NAME`, which bash gives as three words, unless NAME is the last
/// word, which may be incomplete; returns NAME.
std::string take_graph(Words& words) {
  constexpr std::string_view kOption = "--of", kJoined = "--of=";
  std::string name;
  for (auto each = words.begin(); each != words.end(); ++each) {
    const auto left = words.end() - each;
    if (each->starts_with(kJoined) && left > 1) {
      name = each->substr(kJoined.size());
      words.erase(each);
      break;
    }
    const auto length = left > 1 && each[1] == "=" ? 3 : 2;
    if (*each == kOption && left > length) {
      name = each[length - 1];
      words.erase(each, each + length);
      break;
    }
  }
  return name;
}

/// Words for `hc graph VERB`. @param count  of the words after the verb.
Words words_of_graph(const std::string& verb, std::size_t count, const Running& running) {
  if (verb == "set") return with_equals(running.parameters);
  if (verb == "get") {
    auto words = running.modules;
    append(words, running.parameters);
    return words;
  }
  if (verb == "remove" || verb == "restart") return running.modules;
  if (verb == "add" && count == 2) return module_names();
  if (verb == "link") return count == 1 ? running.outputs : running.inputs;
  return verb == "unlink" ? running.links : Words();
}

/// The words that may stand where the last one is.
/// @param words  of the command line, after `hc`; the last one may be empty.
Words completions(const CLI::App& app, Words words) {
  const std::string of = take_graph(words);
  if (words.size() < 2) {
    auto all = verbs_of(app);
    append(all, module_names());
    return all;
  }
  const std::string &name = words.front(), &before = words[words.size() - 2], &word = words.back();
  const CLI::App* verb = find_verb(app, name);
  const CLI::App* inner = verb == nullptr ? nullptr : find_verb(*verb, words[1]);
  if (before == "--of") return running_graphs();
  if (before == "--to" && name == "send") return Running(of).inputs;
  if (before == "--in" || name == "cat" || name == "info" || name == "play" || name == "record" ||
      name == "trace")
    if (!word.starts_with("-")) return Running(of).outputs;
  if (verb == nullptr) return word.starts_with("-") ? options_of_module(name) : Running(of).outputs;
  if (word.starts_with("-")) return options_of(inner == nullptr ? *verb : *inner);
  if (inner != nullptr && words.size() > 2)
    return name == "graph" ? words_of_graph(words[1], words.size() - 2, Running(of)) : Words();
  auto all = verbs_of(*verb);
  const bool takes_graph = name == "run" || name == "check" || name == "doctor" ||
                           name == "graph" || name == "frames" || name == "ports";
  if (takes_graph) append(all, shipped_graphs());
  if (name == "describe" || name == "ports") append(all, module_names());
  if (name == "completion") append(all, {"bash", "zsh", "fish"});
  return all;
}

}  // namespace

void add_completion(CLI::App& app) {
  auto shell = std::make_shared<std::string>("bash");
  auto* completion = app.add_subcommand("completion", "Print a completion script for a shell");
  completion->add_option("shell", *shell, "bash, zsh or fish")
      ->capture_default_str()
      ->check(CLI::IsMember({"bash", "zsh", "fish"}));
  completion->callback([shell] {
    print(*shell == "bash" ? kBash : *shell == "zsh" ? kZsh : kFish);
  });
}

void complete(const CLI::App& app, const std::vector<std::string>& words) {
  constexpr unsigned kPatience = 10;  // with a graph that hangs, unlike a slow machine [s]
  ::alarm(kPatience);
  std::string text;
  for (const auto& word : completions(app, words)) text += word + "\n";
  print(text);
}

}  // namespace tool
