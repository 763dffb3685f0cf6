// SPDX-License-Identifier: Apache-2.0
#pragma once
// A module written in Python: an hc::Module whose loop runs without the GIL, and the calls between
// the loop and Python handlers.

#include <exception>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <frames/module_frames.h>
#include <hc/module/module.h>
#include <hc/module/run.h>

#include "python.h"

namespace python {

/// A Python function that C++ may release on any thread, with or without the GIL.
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
    hc::ModuleAccess::before_waiting(module_, [this] { release(); });
  }

  /// Raises on other threads than the one that runs the module, while it runs.
  void check_thread() const {
    if (is_running_ && std::this_thread::get_id() != thread_) refuse_thread();
  }
  /// The module, after check_thread().
  hc::Module& module() {
    check_thread();
    return module_;
  }
  /// The frames of its graph; the first call declares their ports.
  hc::ModuleFrames& frames() {
    auto& checked = module();
    if (!frames_) frames_.emplace(checked);
    return *frames_;
  }
  /// From any thread.
  void log(const std::string& line, hc::Level level) const { module_.log(line, level); }
  [[nodiscard]] const std::string& name() const { return module_.name(); }

  /// Runs the module; only its handlers hold the GIL. Raises an exception with which a handler
  /// ended the interpreter.
  int run(const std::vector<std::string>& words);

  /// Begins a run in which the inputs without a handler are pulled: next().
  void begin(const std::vector<std::string>& words);
  /// The next message of an input, while the handlers of others are called; none at its end. If the
  /// module has failed, the interpreter exits.
  std::optional<hc::Message> next(const std::string& input);
  /// Ends the run that begin() has begun, if there is one.
  /// @param has_failed  by an exception: on_end() is not called.
  /// @returns  the exit status.
  int end(bool has_failed);
  [[nodiscard]] bool is_pulled() const { return run_ != nullptr; }

  /// Calls a handler from the loop, with the GIL. A hypercolumn.BadMessage, an IndexError or a
  /// cv2.error drops the message. Any other exception ends the module, with the text of a
  /// hypercolumn.Error, or with the name and text of another exception, whose traceback goes to
  /// standard error.
  template <typename... Arguments>
  py::object call(PyObject* handler, Arguments... arguments) {
    PyObject* const all[] = {nullptr, arguments...};
    PyObject* result = PyObject_Vectorcall(
        handler, all + 1, sizeof...(arguments) | PY_VECTORCALL_ARGUMENTS_OFFSET, nullptr);
    if (result == nullptr) end_by_error();
    return py::reinterpret_steal<py::object>(result);
  }

  /// Ends the module with the exception that Python has raised: throws.
  [[noreturn]] void end_by_error();

  /// Holds the GIL for code called by the loop, such as a handler.
  class Inside {
   public:
    /// @param keeps  keeps the GIL for the next handler, until the module waits or does other work.
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

  /// Runs, without the GIL, a call of a handler that may block, such as sending. Raises its
  /// exceptions, and when used outside of handlers. @param name  of the call, for the error.
  template <typename Work>
  void work(const char* name, const Work& work) {
    check_thread();
    if (is_in_script_ && is_stopped_) exit_by(0);
    if (!is_running_)
      raise({hc::Code::Invalid, std::string(name) +
                                    " may only be called in handlers of a running module, or in a "
                                    "script once its loop has begun"});
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
  /// Takes or releases the GIL for the running thread, unless already done.
  void acquire() {
    if (thread_state_ != nullptr) PyEval_RestoreThread(std::exchange(thread_state_, nullptr));
  }
  void release() {
    if (thread_state_ == nullptr) thread_state_ = PyEval_SaveThread();
  }
  [[noreturn]] static void refuse_thread();
  void raise_failure();
  void raise_exit();
  void exit_if_over();
  [[noreturn]] static void exit_by(int status);
  /// Works in the loop of a script, which calls handlers.
  template <typename Work>
  void work_in_loop(const Work& do_work) {
    is_in_script_ = false;
    failure_ = nullptr;
    work("next()", do_work);
    is_in_script_ = true;
  }

  hc::Module module_;
  std::unique_ptr<hc::ModuleAccess::Run> run_;  // of a script
  std::optional<hc::ModuleFrames> frames_;      // used by the module's handlers
  PyThreadState* thread_state_ = nullptr;       // of the running thread; null: it holds the GIL
  std::thread::id thread_;
  bool is_running_ = false;
  bool is_in_script_ = false;                  // rather than in the loop
  bool is_stopped_ = false;                    // as a call of the script has found
  std::exception_ptr failure_;                 // passes through Python, then ends the module
  std::optional<py::error_already_set> exit_;  // with which a handler ends the interpreter
};

/// Has the interpreter exit with a status, after all that it does at its end; 0: with its own.
void exit_with(int status);

}  // namespace python
