// SPDX-License-Identifier: Apache-2.0
#pragma once
// The files of templates/, as the build puts them into this program (cmake/templates.cmake).

#include <string_view>
#include <vector>

namespace tool {

/// @NAME@ stands for the module's name, in path and text.
struct TemplateFile {
  std::string_view path;
  std::string_view text;
};

std::vector<TemplateFile> cpp_template();
std::vector<TemplateFile> python_template();

}  // namespace tool
