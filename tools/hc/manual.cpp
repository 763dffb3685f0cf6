// SPDX-License-Identifier: Apache-2.0
// hc man: generated from the options of all verbs.

#include <hc/base/format.h>

#include "common.h"
#include "verbs.h"

namespace tool {
namespace {

std::vector<const CLI::App*> verbs_of(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App*) { return true; });
}

/// Escapes text for roff.
std::string roff(const std::string& text) {
  std::string result;
  for (char c : text) {
    if (c == '\\' || c == '-') result += '\\';
    result += c == '\n' ? ' ' : c;
  }
  return result.starts_with('.') || result.starts_with('\'') ? "\\&" + result : result;
}

std::string options_text(const CLI::App& verb) {
  std::string text;
  for (const auto* option : verb.get_options())
    text += hc::format(".TP\n.B {}\n{}\n", roff(option->get_name(false, true)),
                       roff(option->get_description()));
  return text;
}

std::string man_page(const CLI::App& app) {
  std::string text = hc::format(".TH HC 1 \"\" \"hc " HC_VERSION
                                "\"\n.SH NAME\nhc \\- {}\n.SH SYNOPSIS\n.B hc\n.I command\n"
                                "[options]\n.br\n.B hc\n.I module\n[options]\n.SH COMMANDS\n",
                                roff(app.get_description()));
  for (const auto* verb : verbs_of(app)) {
    text += hc::format(".SS hc {}\n{}\n{}", roff(verb->get_name()), roff(verb->get_description()),
                       options_text(*verb));
    for (const auto* each : verbs_of(*verb))
      text += hc::format(".TP\n.B hc {} {}\n{}\n", roff(verb->get_name()), roff(each->get_name()),
                         roff(each->get_description()));
  }
  return text +
         ".SH ENVIRONMENT\n.TP\n.B HC_GRAPH\nthe running graph that commands use if there are "
         "several\n.SH EXIT STATUS\n0 done, 1 failed, 2 wrong arguments or graph\n";
}

}  // namespace

void add_manual(CLI::App& app) {
  auto* man = app.add_subcommand("man", "Print the manual page of hc");
  man->callback([&app] { print(man_page(app)); });
}

}  // namespace tool
