// SPDX-License-Identifier: Apache-2.0
#pragma once
// The verbs: each adds its subcommand, with what is to be done, to the command line.

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

namespace tool {
void add_cat(CLI::App& app);
void add_describe(CLI::App& app);
void add_info(CLI::App& app);
void add_play(CLI::App& app);
void add_record(CLI::App& app);
void add_run(CLI::App& app);
void add_send(CLI::App& app);

}  // namespace tool
