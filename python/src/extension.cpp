// SPDX-License-Identifier: Apache-2.0
// The extension _hypercolumn, on which the package's Python files build.
#include <exception>
#include <utility>

#include <hc/module/module.h>
#include <transports/all.h>

#include "python.h"

PYBIND11_MODULE(_hypercolumn, extension) {
  using namespace python;
  hc::add_all_transports();
  py::register_exception_translator([](std::exception_ptr thrown) {
    if (!thrown) return;
    try {
      std::rethrow_exception(std::move(thrown));
    } catch (const hc::ModuleError& error) {
      set_error_text(error.what());
    }
  });
  add_messages(extension);
  add_kinds(extension);
  add_modules(extension);
  add_outputs(extension);
  add_streams(extension);
}
