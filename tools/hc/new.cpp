// SPDX-License-Identifier: Apache-2.0
// hc new: creates a module outside this project, from templates built into this program.

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <utility>

#include <hc/base/format.h>

#include "common.h"
#include "templates.h"
#include "verbs.h"

namespace tool {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxModuleName = 40;

struct NewOptions {
  std::string name;
  std::string folder = ".";
  bool is_python = false;
};

bool is_snake_case(const std::string& name) {
  return !name.empty() && name.size() <= kMaxModuleName && name[0] >= 'a' && name[0] <= 'z' &&
         name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_") == std::string::npos;
}

void replace_all(std::string& text, std::string_view word, std::string_view by) {
  for (auto at = text.find(word); at != std::string::npos; at = text.find(word, at + by.size()))
    text.replace(at, word.size(), by);
}

/// The templates are under this project's licence; modules made from them belong to their authors.
void remove_licence(std::string& text) {
  auto at = text.find("SPDX-License-Identifier");
  if (at == std::string::npos) return;
  auto begin = text.rfind('\n', at);
  begin = begin == std::string::npos ? 0 : begin + 1;
  text.erase(begin, text.find('\n', at) + 1 - begin);
}

void write_file(const fs::path& path, const std::string& text) {
  fs::create_directories(path.parent_path());
  std::ofstream file(path, std::ios::binary);
  file << text;
  file.close();
  if (!file) throw Failure(hc::Code::System, path.string() + " cannot be written");
  if (text.starts_with("#!"))
    fs::permissions(path, fs::perms::owner_exec | fs::perms::group_exec | fs::perms::others_exec,
                    fs::perm_options::add);
}

/// Why a Python cannot import the package hypercolumn: its last line; empty if it can.
std::string why_not_importable(const std::string& python) {
  FILE* pipe = ::popen((python + " -c 'import hypercolumn' 2>&1").c_str(), "r");
  if (pipe == nullptr) return std::strerror(errno);
  std::string last;
  std::array<char, 1000> line{};
  while (std::fgets(line.data(), line.size(), pipe) != nullptr) last = line.data();
  const bool has_failed = ::pclose(pipe) != 0;
  while (last.ends_with('\n')) last.pop_back();
  return !has_failed ? "" : last.empty() ? "failed" : last;
}

/// The Python that has the package hypercolumn, with its libraries: not always the first in PATH.
std::string python() {
  const std::string first = "python3", of_system = "/usr/bin/python3";
  std::vector<std::string> reasons;
  for (const auto& each : {first, of_system}) {
    const auto why = why_not_importable(each);
    if (why.empty()) return each;
    reasons.push_back(each + ": " + why);
  }
  say("hc new: no Python has the package hypercolumn and NumPy (doc/python.md): " +
      joined(reasons, "; "));
  return first;
}

/// The commands that build and test a module in C++ with the library of this program. CMake finds
/// the library by itself only in /usr; from a build tree, it is installed first.
std::string build_commands() {
  fs::path prefix = module_folder().parent_path().parent_path();
  std::string install, option;
  if (fs::exists(prefix / "CMakeCache.txt")) {
    const auto build = std::exchange(prefix, prefix / "installed");
    install = "cmake --install " + build.string() + " --prefix " + prefix.string() + " && ";
  }
  if (prefix != "/usr" && prefix != "/usr/local")
    option = " -DCMAKE_PREFIX_PATH=" + prefix.string();
  return install + "cmake -S . -B build" + option +
         " && cmake --build build && ctest --test-dir build";
}

void begin(const NewOptions& options) {
  if (!is_snake_case(options.name))
    throw Failure(hc::Code::Invalid,
                  hc::format("a module's name must be snake_case of at most {} letters, "
                             "not \"{}\"",
                             kMaxModuleName, options.name));
  const auto shipped = module_names();
  if (std::ranges::find(shipped, options.name) != shipped.end())
    throw Failure(hc::Code::Invalid,
                  hc::format("\"{}\" is a module of Hypercolumn, which hc and graphs would run "
                             "instead of the new one; choose another name",
                             options.name));
  if (const auto hint = meant_command(options.name); !hint.empty())
    throw Failure(hc::Code::Invalid, hc::format("hc would take \"{}\" for a command{}; choose "
                                                "another name",
                                                options.name, hint));
  const fs::path folder = (fs::path(options.folder) / options.name).lexically_normal();
  std::error_code error;
  if (fs::exists(fs::symlink_status(folder, error)))
    throw Failure(hc::Code::Invalid, folder.string() + " already exists");
  fs::create_directories(folder, error);
  if (error) throw Failure(hc::Code::System, folder.string() + ": " + error.message());
  const std::string interpreter = options.is_python ? python() : "";
  const std::string build = options.is_python ? "" : build_commands();
  for (const auto& file : options.is_python ? python_template() : cpp_template()) {
    std::string path(file.path), text(file.text);
    replace_all(path, "@NAME@", options.name);
    replace_all(text, "@NAME@", options.name);
    replace_all(text, "@BUILD@", build);
    if (interpreter.starts_with('/'))
      replace_all(text, "#!/usr/bin/env python3", "#!" + interpreter);
    remove_licence(text);
    write_file(folder / path, text);
  }
  const std::string test =
      options.is_python ? interpreter + " " + options.name + "_test.py" : build;
  print(hc::format("created {}/; next: cd {} && {}\n", folder.string(), folder.string(), test));
}

}  // namespace

void add_new(CLI::App& app) {
  auto options = std::make_shared<NewOptions>();
  auto* verb = app.add_subcommand("new", "Create a module from a template");
  verb->require_subcommand(1);
  auto* module = verb->add_subcommand("module", "Create a folder with a module and its test");
  module->add_option("name", options->name, "the module's name, in snake_case; also the folder's")
      ->required();
  module->add_flag("--python", options->is_python,
                   "in Python, with the package hypercolumn (default: C++)");
  module->add_option("--folder", options->folder, "parent folder (default: this one)");
  module->callback([options] { begin(*options); });
}

}  // namespace tool
