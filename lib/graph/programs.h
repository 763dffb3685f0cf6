// SPDX-License-Identifier: Apache-2.0
#pragma once
// Where programs of modules are, and what they say of themselves.

#include <filesystem>
#include <string>
#include <vector>

#include <hc/base/result.h>

namespace hc {

/// The folder of the modules that were installed with this program: ../libexec/hypercolumn.
std::filesystem::path module_folder();

/// The names of all modules in that folder.
std::vector<std::string> module_names();

/// The folder of the graphs that came with this program; where it was built, a link.
std::filesystem::path graph_folder();

/// A program by its path, or by its name in module_folder() or PATH; empty when there is none.
std::string find_program(const std::string& name);

/// Why find_program() finds no program of this name, and what to do.
std::string no_program(const std::string& name);

/// What `program --describe` prints, at most 1 MiB, within 10 s.
///
/// Errors: System (it cannot be executed, or failed), Stopped (`stop` is readable).
Result<std::string> describe_program(const std::string& program, int stop = -1);

}  // namespace hc
