// SPDX-License-Identifier: Apache-2.0
// hc describe: prints a module's ports and parameters.
#include <nlohmann/json.hpp>

#include <graph/run.h>

#include "common.h"
#include "verbs.h"

namespace tool {

void add_describe(CLI::App& app) {
  auto name = std::make_shared<std::string>();
  auto* verb = app.add_subcommand("describe", "Print a module's ports and parameters as JSON");
  verb->add_option("module", *name, "a module, or any program that supports --describe")
      ->required();
  verb->callback([name] {
    std::string program = find_program(*name);
    if (program.empty()) throw Failure(hc::Code::NotFound, hc::no_program(*name));
    auto text = value_or_fail(hc::describe_program(program), *name);
    auto json = nlohmann::ordered_json::parse(text, nullptr, false);
    if (json.is_discarded())
      throw Failure(hc::Code::Malformed, *name + " --describe does not print JSON");
    print(json.dump(2) + "\n");
  });
}

}  // namespace tool
