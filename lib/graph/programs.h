// SPDX-License-Identifier: Apache-2.0
#pragma once
// Finds the programs of modules and asks for their descriptions.

#include <filesystem>
#include <string>
#include <vector>

#include <hc/base/result.h>

namespace hc {

/// The folder of the modules installed with this program: ../libexec/hypercolumn.
std::filesystem::path module_folder();

/// The names of all modules in that folder.
std::vector<std::string> module_names();

/// The folder of the shipped graphs; in a build tree, a symbolic link.
std::filesystem::path graph_folder();

/// Finds a program by its path, or by its name in module_folder() or PATH; empty if not found.
std::string find_program(const std::string& name);

/// An error message for a name that find_program() does not find, with what to do.
/// @param path  of the program, if its name has a slash.
std::string no_program(const std::string& name, const std::string& path);
inline std::string no_program(const std::string& name) {
  return no_program(name, name);
}

/// The output of `program --describe`, at most 1 MiB, within 10 s.
///
/// Errors: System (it cannot be executed, or failed), Stopped (`stop` is readable).
Result<std::string> describe_program(const std::string& program, int stop = -1);

}  // namespace hc
