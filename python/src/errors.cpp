// SPDX-License-Identifier: Apache-2.0
#include "python.h"

#include <exception>
#include <filesystem>
#include <new>
#include <stdexcept>

#include <hc/module/module.h>

namespace python {
namespace {

PyObject* import_error(const char* name) {
  return py::object(py::module_::import("hypercolumn.errors").attr(name)).release().ptr();
}

}  // namespace

PyObject* error_type() {
  static PyObject* type = import_error("Error");
  return type;
}

PyObject* bad_message_type() {
  static PyObject* type = import_error("BadMessage");
  return type;
}

PyObject* stopped_type() {
  static PyObject* type = import_error("Stopped");
  return type;
}

void set_error(const std::string& text, std::string_view code) {
  PyObject* error =
      PyObject_CallFunction(error_type(), "ss", text.c_str(), std::string(code).c_str());
  if (error == nullptr) return;
  PyErr_SetObject(error_type(), error);
  Py_DECREF(error);
}

void set_error_text(const std::string& text) {
  using hc::Code;
  for (auto code : {Code::Malformed, Code::Unsupported, Code::TooLarge, Code::Truncated,
                    Code::Closed, Code::Stopped, Code::NotFound, Code::Invalid, Code::System})
    if (text.starts_with(std::string(hc::name(code)) + ": "))
      return set_error(text, hc::name(code));
  set_error(text, "");
}

std::string Line::file_name() const {
  return std::filesystem::path(py::str(file).cast<std::string>()).filename().string();
}

std::optional<Line> current_line() {
  PyFrameObject* frame = PyEval_GetFrame();  // borrowed
  if (frame == nullptr) return std::nullopt;
  const auto code =
      py::reinterpret_steal<py::object>(reinterpret_cast<PyObject*>(PyFrame_GetCode(frame)));
  return Line{code.attr("co_filename"), PyFrame_GetLineNumber(frame)};
}

void set_current_exception() noexcept try {
  try {
    throw;
  } catch (const std::bad_alloc&) {
    PyErr_NoMemory();
  } catch (py::error_already_set& error) {
    error.restore();
  } catch (const py::builtin_exception& error) {
    error.set_error();
  } catch (const hc::ModuleError& error) {
    set_error_text(error.what());
  } catch (const std::exception& error) {
    set_error(error.what(), "");
  } catch (...) {
    PyErr_SetNone(stopped_type());
  }
} catch (...) {  // no memory for its text
  PyErr_NoMemory();
}

}  // namespace python
