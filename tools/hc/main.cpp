// SPDX-License-Identifier: Apache-2.0
// hc: runs and inspects graphs of modules. `hc NAME …` starts a module.
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <system_error>

#include <graph/programs.h>
#include <hc/base/format.h>
#include <hc/base/suggestion.h>
#include <hc/contract/description.h>
#include <hc/os/program.h>
#include <transports/all.h>

#include "common.h"
#include "observer.h"
#include "verbs.h"
#include "words.h"

namespace tool {
extern const char kCommit[];  // written by cmake/commit.cmake
}

namespace {

constexpr int kUsage = 2;

std::string version() {
  std::string text =
      hc::format("hc {}, commit {}\nfeatures:{}", HC_VERSION, tool::kCommit, HC_FEATURES);
  constexpr std::string_view kLacking = HC_LACKING;  // NOLINT(*-redundant-string-init): may be ""
  if (!kLacking.empty()) text += hc::format("\nnot built:{}", kLacking);
  return text;
}

std::string footer() {
  std::string text = "Modules (hc NAME --help):";
  for (const auto& name : tool::module_names()) text += " " + name;
  return text +
         "\nA link's end is -, a file, tcp:HOST:PORT, tcp-listen:PORT, tls:HOST:PORT, "
         "tls-listen:PORT, unix:PATH, "
         "unix-listen:PATH, shm:NAME, dds:TOPIC.";
}

constexpr const char* kOverview =
    "hc runs and inspects graphs of modules that send each other matrices.\n\n"
    "  hc run graphs/depth.toml     run a graph (hc check: find its errors first)\n"
    "  hc top                       show what the running graph does\n"
    "  hc cat MODULE.PORT           print what a port sends (view: in a window)\n"
    "  hc graph set MODULE.NAME=7   change it while it runs\n"
    "  hc estop                     stop the robot (hc graph stop: end the graph)\n"
    "  hc MODULE --help             a module's ports and parameters\n\n"
    "All commands: hc --help. Any command: hc COMMAND --help.\n";

/// Takes `--of NAME` from the arguments; empty if it is not given.
std::string take_of(std::vector<std::string>& arguments) {
  const auto found = std::find(arguments.begin(), arguments.end(), "--of");
  if (found == arguments.end() || found + 1 == arguments.end()) return "";
  std::string name = found[1];
  arguments.erase(found, found + 2);
  return name;
}

/// Gives the value of --in or --out, [PORT=]WORD, the meaning that a word has in all verbs.
std::string link_value(const std::string& value, const std::string& of, bool is_input) {
  const auto equals = value.find('=');
  const bool has_port = equals != std::string::npos && value.find_first_of(":/.?") > equals;
  const auto word = has_port ? value.substr(equals + 1) : value;
  if (!is_input) tool::check_output(word);
  if (!is_input || !tool::graph_of_port(word, of)) return value;
  return value.substr(0, value.size() - word.size()) + tool::place_of(word, of).uri.text();
}

/// The arguments of a module, with links in place of ports of running graphs: in --in, and as the
/// first word, for the module's only input.
std::vector<std::string> module_arguments(const std::string& program,
                                          std::vector<std::string> arguments) {
  const std::string of = take_of(arguments);
  if (arguments.size() >= 2 && !arguments[1].starts_with("-") &&
      arguments[1].find_first_of("/:=") == std::string::npos) {
    const auto text = hc::describe_program(program);
    const auto description = hc::parse_description(text ? *text : "");
    if (description && description->inputs.size() == 1 && tool::graph_of_port(arguments[1], of))
      arguments[1] = "--in=" + description->inputs[0].name + "=" + arguments[1];
  }
  for (std::size_t i = 1; i < arguments.size(); ++i)
    for (const bool is_input : {true, false}) {
      const std::string option = is_input ? "--in" : "--out";
      if (arguments[i - 1] == option)
        arguments[i] = link_value(arguments[i], of, is_input);
      else if (arguments[i].starts_with(option + "="))
        arguments[i] =
            option + "=" + link_value(arguments[i].substr(option.size() + 1), of, is_input);
    }
  return arguments;
}

/// A suggestion for an unknown option of a verb, or for the name of a running graph.
std::string meant_option(const CLI::App& app) {
  const CLI::App* verb = &app;
  while (!verb->get_subcommands().empty()) verb = verb->get_subcommands().back();
  std::vector<std::string> known;
  for (const auto* option : verb->get_options())
    for (const auto& name : option->get_lnames()) known.push_back("--" + name);
  for (const auto& word : app.remaining(true))
    if (word.starts_with("--")) return hc::suggestion(word.substr(0, word.find('=')), known);
  const bool has_of = std::ranges::find(known, "--of") != known.end();
  for (const auto& word : app.remaining(true))
    for (const auto& graph : tool::find_running())
      if (has_of && (graph.name == word || graph.text() == word))
        return ", did you mean \"--of " + word + "\"?";
  return "";
}

/// Appends the Python package that came with this program to PYTHONPATH, if it is not in Python's
/// default path.
void offer_python_package() {
  namespace fs = std::filesystem;
  const fs::path prefix = tool::module_folder().parent_path().parent_path();
  std::error_code missing;
  fs::path found = prefix / "python";  // of a build
  if (prefix != "/usr" && prefix != "/usr/local")
    for (const auto& entry : fs::directory_iterator(prefix / "lib", missing))
      if (entry.path().filename().string().starts_with("python"))
        found = entry.path() / "dist-packages";
  if (!fs::is_directory(found / "hypercolumn", missing)) return;
  const char* known = std::getenv("PYTHONPATH");
  const std::string first = known == nullptr || *known == '\0' ? "" : std::string(known) + ":";
  ::setenv("PYTHONPATH", (first + found.string()).c_str(), 1);
}

/// Executes the module of that name; returns if there is none.
void become_module(const std::string& name, char** argv) {
  std::string program = tool::find_program(name);
  if (program.empty()) return;
  std::vector<std::string> words;
  for (char** word = argv; *word != nullptr; ++word) words.emplace_back(*word);
  words = module_arguments(program, std::move(words));
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (auto& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  ::execv(program.c_str(), arguments.data());
  tool::say(hc::format("hc: {}: {}", program, std::strerror(errno)));
}

}  // namespace

int main(int argc, char** argv) {
  hc::prepare_program();
  hc::add_all_transports();
  CLI::App app{"Runs and inspects graphs of modules that send each other matrices.", "hc"};
  app.set_version_flag("--version", version, "version, commit, and what depends on this build");
  app.require_subcommand(1);
  app.footer(footer);
  using namespace tool;
  for (const auto add : {add_run,   add_check, add_doctor, add_estop,      add_frames, add_graph,
                         add_ports, add_ps,    add_top,    add_page,       add_trace,  add_cat,
                         add_info,  add_send,  add_record, add_play,       add_replay, add_describe,
                         add_new,   add_key,   add_agent,  add_completion, add_manual})
    add(app);

  if (argc == 1) {
    print(kOverview);
    return kUsage;
  }
  offer_python_package();
  // `hc help VERB` is `hc VERB --help`.
  std::vector<char*> words(argv, argv + argc + 1);  // and a null pointer
  if (std::string(argv[1]) == "help") {
    static char help[] = "--help";
    words.erase(words.begin() + 1);
    words.insert(words.begin() + std::min(argc - 1, 2), help);
  }
  argv = words.data();
  const std::string first = argv[1];
  const auto verbs = app.get_subcommands([](const CLI::App*) { return true; });
  const bool is_verb =
      std::ranges::any_of(verbs, [&](const auto* verb) { return verb->get_name() == first; });
  const std::string command = is_verb ? "hc " + first : "hc";
  try {
    if (first == "complete" && argc > 3) {  // hc complete -- WORD …, which may be any words
      complete(app, {argv + 3, argv + argc});
      return 0;
    }
    if (!is_verb && !first.empty() && first[0] != '-') {
      auto known = module_names();
      const auto hint = meant_command(first);
      if (hint.empty() || std::ranges::find(known, first) != known.end())
        become_module(first, argv + 1);
      if (first.find('/') != std::string::npos) {
        say("hc: " + hc::no_program(first));
        return kUsage;
      }
      for (const auto* verb : verbs) known.push_back(verb->get_name());
      say(hc::format("hc: unknown command or module \"{}\"{}", first,
                     hint.empty() ? hc::suggestion(first, known) + "; see hc --help" : hint));
      return kUsage;
    }
    app.parse(argc, argv);
    return 0;
  } catch (const CLI::ExtrasError& error) {
    say(hc::format("{}: {}{}", command, error.what(), meant_option(app)));
    return kUsage;
  } catch (const CLI::ParseError& error) {
    // --help and --version are also reported as ParseError.
    if (error.get_exit_code() == 0) return app.exit(error);
    say(hc::format("{}: {}", command, error.what()));
    return kUsage;
  } catch (const Failure& failure) {
    const bool is_silent = failure.status == 0 || *failure.what() == '\0';
    if (!is_silent) say(hc::format("hc {}: {}", first, failure.what()));
    return failure.status;
  } catch (const std::exception& error) {
    say(hc::format("hc {}: {}", first, error.what()));
    return 1;
  }
}
