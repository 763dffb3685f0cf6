// SPDX-License-Identifier: Apache-2.0
#pragma once
// A module written in Python: an hc::Module, and the way between its loop, which runs without the
// GIL, and its handlers.

#include <exception>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <hc/module/module.h>

#include "python.h"

namespace python {

/// A Python function that C++ may let go of on any thread, with the GIL or without.
using Function = std::shared_ptr<PyObject>;
Function hold(const py::object& function);

class Program {
 public:
  Program(std::string name, std::string summary) : module(std::move(name), std::move(summary)) {}

  hc::Module module;

  /// Runs the module; the GIL is free meanwhile but for its handlers. Raises what a handler has
  /// raised to end the interpreter.
  int run(const std::vector<std::string>& words);

  [[nodiscard]] bool is_running() const { return is_running_; }

  /// Calls a handler from the loop, with the GIL. A handler that raises ends the module: by the
  /// text of a hypercolumn.Error; or by name and text of another exception, whose traceback goes to
  /// standard error.
  template <typename... Arguments>
  py::object call(PyObject* handler, Arguments... arguments) {
    PyObject* const all[] = {nullptr, arguments...};
    PyObject* result = PyObject_Vectorcall(
        handler, all + 1, sizeof...(arguments) | PY_VECTORCALL_ARGUMENTS_OFFSET, nullptr);
    if (result == nullptr) end_by_error();
    return py::reinterpret_steal<py::object>(result);
  }

  /// Ends the module by what Python has raised: throws.
  [[noreturn]] void end_by_error();

  /// What runs in the loop with the GIL, as a handler does.
  class Inside {
   public:
    explicit Inside(Program& program) : program_(program) {
      PyEval_RestoreThread(program_.thread_state_);
    }
    ~Inside() { program_.thread_state_ = PyEval_SaveThread(); }
    Inside(const Inside&) = delete;
    Inside& operator=(const Inside&) = delete;

   private:
    Program& program_;
  };

  /// Does, without the GIL, what a handler asks of the module and may wait, such as sending; false
  /// when Python has raised. Of the thread that runs the module alone.
  template <typename Work>
  bool work(const Work& work) {
    if (is_running_ && std::this_thread::get_id() != thread_) return refuse_thread();
    PyThreadState* outer = PyEval_SaveThread();
    std::swap(thread_state_, outer);
    try {
      work();
    } catch (...) {
      failure_ = std::current_exception();
    }
    std::swap(thread_state_, outer);
    PyEval_RestoreThread(outer);
    return failure_ == nullptr || raise_failure();
  }

 private:
  static bool refuse_thread();
  bool raise_failure();

  PyThreadState* thread_state_ = nullptr;  // of the thread that runs, while it has not the GIL
  std::thread::id thread_;
  bool is_running_ = false;
  std::exception_ptr failure_;  // went through Python, and ends the module where it comes out
  std::optional<py::error_already_set> exit_;  // what a handler ends the interpreter by
};

}  // namespace python
