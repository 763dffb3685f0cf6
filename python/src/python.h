// SPDX-License-Identifier: Apache-2.0
#pragma once
// Shared by the parts of the extension _hypercolumn: conversion of errors, and the parts' entry
// points. Code that runs for each message uses Python's C API, all else pybind11.

#include <pybind11/pybind11.h>

#include <optional>
#include <string>
#include <string_view>

#include <hc/base/result.h>

namespace python {

namespace py = pybind11;

/// Sets a Python hypercolumn.Error with this text; `code` is the name of an hc::Code, or empty.
void set_error(const std::string& text, std::string_view code);
inline void set_error(const hc::Error& error) {
  set_error(error.text(), hc::name(error.code));
}
/// The same for the text of an hc::ModuleError, which may start with a code.
void set_error_text(const std::string& text);

[[noreturn]] inline void raise(const hc::Error& error) {
  set_error(error);
  throw py::error_already_set();
}

/// The value of a result; raises its error.
template <typename T>
T value_or_raise(hc::Result<T> result) {
  if (!result) raise(result.error());
  return std::move(*result);
}
inline void raise_if_failed(const hc::Status& status) {
  if (!status) raise(status.error());
}

/// Sets a Python error from the C++ exception being handled. The exception that stops a module
/// becomes hypercolumn.Stopped, and is kept by the module (see Program).
void set_current_exception() noexcept;

/// Wraps a function for Python: C++ exceptions become Python exceptions.
template <auto kFunction>
struct Guard;
template <typename... Arguments, PyObject* (*kFunction)(Arguments...)>
struct Guard<kFunction> {
  static PyObject* call(Arguments... arguments) noexcept {
    try {
      return kFunction(arguments...);
    } catch (...) {
      set_current_exception();
      return nullptr;
    }
  }
};
template <auto kFunction>
constexpr auto guarded = Guard<kFunction>::call;

/// hypercolumn.Error, BadMessage and Stopped, from hypercolumn/errors.py.
PyObject* error_type();
PyObject* bad_message_type();
PyObject* stopped_type();

/// A line of Python code.
struct Line {
  py::object file;
  int number = 0;

  /// The file's name without its folder.
  [[nodiscard]] std::string file_name() const;
};
/// The calling line; nothing if the caller is not Python code.
std::optional<Line> current_line();

/// Raises if a signal handler did, e.g. for Ctrl-C while waiting.
inline void check_signals() {
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
}

void add_messages(py::module_& extension);
void add_kinds(py::module_& extension);
void add_modules(py::module_& extension);
void add_outputs(py::module_& extension);
void add_streams(py::module_& extension);

}  // namespace python
