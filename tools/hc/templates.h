// SPDX-License-Identifier: Apache-2.0
#pragma once
// The files of templates/, built into this program (cmake/templates.cmake).

#include <string_view>
#include <vector>

namespace tool {

/// In path and text, @NAME@ is the module's name.
struct TemplateFile {
  std::string_view path;
  std::string_view text;
};

std::vector<TemplateFile> cpp_template();
std::vector<TemplateFile> python_template();

}  // namespace tool
