// SPDX-License-Identifier: Apache-2.0
#pragma once
// A module written in Python: an hc::Module, and the way between its loop, which runs without the
// GIL, and its handlers.

#include <exception>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <frames/module_frames.h>
#include <hc/module/module.h>

#include "python.h"

namespace python {

/// A Python function that C++ may let go of on any thread, with the GIL or without.
using Function = std::shared_ptr<PyObject>;
Function hold(const py::object& function);

class Program {
 public:
  Program(std::string name, std::string summary, bool background, bool keep_running,
          bool finish_when_stopped)
      : module_(std::move(name), std::move(summary),
                {.background = background,
                 .keep_running = keep_running,
                 .finish_when_stopped = finish_when_stopped}) {
    hc::internal::ModuleAccess::before_waiting(module_, [this] { release(); });
  }

  /// Of the thread that runs the module alone, while it runs; raised on another one.
  void check_thread() const {
    if (is_running_ && std::this_thread::get_id() != thread_) refuse_thread();
  }
  /// The module, where check_thread() lets it be used.
  hc::Module& module() {
    check_thread();
    return module_;
  }
  /// The frames of its graph, declared by the first call.
  hc::ModuleFrames& frames() {
    auto& checked = module();
    if (!frames_) frames_.emplace(checked);
    return *frames_;
  }
  /// Its name in the graph and a line, on any thread.
  void log(const std::string& line, hc::Level level) const { module_.log(line, level); }
  [[nodiscard]] const std::string& name() const { return module_.name(); }

  /// Runs the module; the GIL is free meanwhile but for its handlers. Raises what a handler has
  /// raised to end the interpreter.
  int run(const std::vector<std::string>& words);

  /// Calls a handler from the loop, with the GIL. A hypercolumn.BadMessage drops the message. Any
  /// other exception ends the module: by the text of a hypercolumn.Error; or by name and text of
  /// another, whose traceback goes to standard error.
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
    /// @param keeps  keeps the GIL until the module waits, or does something else than to call
    ///               handlers: a next one that is called at once need not take it again.
    explicit Inside(Program& program, bool keeps = false) : program_(program), keeps_(keeps) {
      program_.acquire();
    }
    ~Inside() {
      if (!keeps_) program_.release();
    }
    Inside(const Inside&) = delete;
    Inside& operator=(const Inside&) = delete;

   private:
    Program& program_;
    bool keeps_;
  };

  /// Does, without the GIL, what a handler asks of the module and may wait, such as sending. What
  /// it throws is raised; so is a use outside of handlers. @param name  of what is asked.
  template <typename Work>
  void work(const char* name, const Work& work) {
    check_thread();
    if (!is_running_)
      raise({hc::Code::Invalid, std::string(name) + " is for the handlers of a module that runs"});
    release();
    try {
      work();
    } catch (...) {
      failure_ = std::current_exception();
    }
    acquire();
    if (failure_ != nullptr) raise_failure();
  }

 private:
  /// Takes the GIL for the thread that runs, and gives it back; nothing where that is done.
  void acquire() {
    if (thread_state_ != nullptr) PyEval_RestoreThread(std::exchange(thread_state_, nullptr));
  }
  void release() {
    if (thread_state_ == nullptr) thread_state_ = PyEval_SaveThread();
  }
  [[noreturn]] static void refuse_thread();
  [[noreturn]] void raise_failure();

  hc::Module module_;
  std::optional<hc::ModuleFrames> frames_;  // which the module's handlers use: as long as it
  PyThreadState* thread_state_ = nullptr;   // of the thread that runs; null: it has the GIL
  std::thread::id thread_;
  bool is_running_ = false;
  std::exception_ptr failure_;  // went through Python, and ends the module where it comes out
  std::optional<py::error_already_set> exit_;  // what a handler ends the interpreter by
};

}  // namespace python
