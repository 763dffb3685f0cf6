// SPDX-License-Identifier: Apache-2.0
// hc: runs and inspects graphs of modules. `hc NAME …` starts a module.
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include <hc/base/suggestion.h>

#include "common.h"
#include "verbs.h"

namespace {

constexpr int kUsage = 2;

std::string footer() {
  std::string text = "Modules (hc NAME --help):";
  for (const auto& name : tool::module_names()) text += " " + name;
  return text +
         "\nA link's end is -, a file, tcp:HOST:PORT, tcp-listen:PORT, unix:PATH, "
         "unix-listen:PATH, shm:NAME.";
}

/// Becomes the module of that name; comes back when there is none.
void become_module(const std::string& name, char** argv) {
  std::string program = tool::find_program(name);
  if (program.empty()) return;
  ::execv(program.c_str(), argv);
  tool::say(fmt::format("hc: {}: {}", program, std::strerror(errno)));
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Runs and inspects graphs of modules that send each other matrices.", "hc"};
  app.set_version_flag("--version", "hc " HC_VERSION);
  app.require_subcommand(1);
  app.footer(footer);
  tool::add_run(app);
  tool::add_check(app);
  tool::add_doctor(app);
  tool::add_graph(app);
  tool::add_ps(app);
  tool::add_top(app);
  tool::add_cat(app);
  tool::add_info(app);
  tool::add_send(app);
  tool::add_record(app);
  tool::add_play(app);
  tool::add_describe(app);
  tool::add_new(app);

  std::string first = argc > 1 ? argv[1] : "";
  auto verbs = app.get_subcommands([&](const CLI::App* verb) { return verb->get_name() == first; });
  bool is_verb = !verbs.empty();
  if (!first.empty() && first[0] != '-' && !is_verb) {
    become_module(first, argv + 1);
    std::vector<std::string> known = tool::module_names();
    for (const auto* verb : app.get_subcommands([](const CLI::App*) { return true; }))
      known.push_back(verb->get_name());
    tool::say(fmt::format("hc: no verb and no module \"{}\"{}; see hc --help", first,
                          hc::suggestion(first, known)));
    return kUsage;
  }
  try {
    app.parse(argc, argv);
    return 0;
  } catch (const CLI::ParseError& error) {
    // Help and version come this way too.
    if (error.get_exit_code() == 0) return app.exit(error);
    tool::say(fmt::format("hc{}: {}", is_verb ? " " + first : "", error.what()));
    return kUsage;
  } catch (const tool::Failure& failure) {
    bool is_told = failure.status == 0 || *failure.what() == '\0';
    if (!is_told) tool::say(fmt::format("hc {}: {}", first, failure.what()));
    return failure.status;
  } catch (const std::exception& error) {
    tool::say(fmt::format("hc {}: {}", first, error.what()));
    return 1;
  }
}
