// SPDX-License-Identifier: Apache-2.0
#include "program.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include <hc/module/ending.h>

namespace python {
namespace {

hc::ModuleError module_error(const std::string& text, std::string_view code) {
  hc::ModuleError error(text);
  error.is_usage = code == hc::name(hc::Code::Invalid);
  return error;
}

int exit_status = 0;

/// Where an exception was raised: " (redness, line 12)"; if that was in a library, such as NumPy,
/// where the library was called.
std::string place_of(const py::error_already_set& raised) {
  std::string place;
  for (py::object trace = raised.trace(); trace && !trace.is_none();
       trace = trace.attr("tb_next")) {
    const py::object file = trace.attr("tb_frame").attr("f_code").attr("co_filename");
    const auto name = file.cast<std::string>();
    const bool is_library = name.find("-packages/") != std::string::npos || name.starts_with('<');
    if (is_library && !place.empty()) continue;
    const Line line{file, trace.attr("tb_lineno").cast<int>()};
    place = " (" + line.file_name() + ", line " + std::to_string(line.number) + ")";
  }
  return place;
}

/// The name of an exception that means a bad message, as in C++: an index that a message does not
/// have, or an image that OpenCV refuses; empty for others.
std::string refusal(const py::error_already_set& raised) {
  if (raised.matches(PyExc_IndexError)) return "IndexError";
  const py::object opencv = py::module_::import("sys").attr("modules").attr("get")("cv2");
  return !opencv.is_none() && raised.matches(opencv.attr("error")) ? "cv2.error" : "";
}

}  // namespace

void exit_with(int status) {
  exit_status = status;
  Py_AtExit([] {
    std::fflush(nullptr);
    if (exit_status != 0) std::_Exit(exit_status);
  });
}

Function hold(const py::object& function) {
  return {function.inc_ref().ptr(), [](PyObject* held) {
            if (Py_IsInitialized() == 0) return;
            const PyGILState_STATE state = PyGILState_Ensure();
            Py_DECREF(held);
            PyGILState_Release(state);
          }};
}

int Program::run(const std::vector<std::string>& words) {
  if (is_running_)
    raise({hc::Code::Invalid, run_ == nullptr ? "the module is already running"
                                              : "the module is already running: one that takes "
                                                "messages in a loop needs no run()"});
  std::vector<std::string> copies = words;
  std::vector<char*> pointers;
  pointers.reserve(copies.size() + 1);
  for (auto& word : copies) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  int status = 0;
  is_running_ = true;
  thread_ = std::this_thread::get_id();
  release();
  std::exception_ptr thrown;
  try {
    status = module_.run(static_cast<int>(copies.size()), pointers.data());
  } catch (...) {
    thrown = std::current_exception();
  }
  acquire();
  is_running_ = false;
  failure_ = nullptr;
  if (thrown) std::rethrow_exception(thrown);
  raise_exit();
  return status;
}

void Program::begin(const std::vector<std::string>& words) {
  if (is_running_) raise({hc::Code::Invalid, "the module is already running"});
  is_running_ = true;
  thread_ = std::this_thread::get_id();
  for (const auto& input : hc::ModuleAccess::inputs(module_)) input->is_pulled = !input->handler;
  work("begin()", [&] { run_ = std::make_unique<hc::ModuleAccess::Run>(module_, words); });
  is_in_script_ = true;
  exit_if_over();
}

std::optional<hc::Message> Program::next(const std::string& input) {
  const auto& inputs = hc::ModuleAccess::inputs(module_);
  const auto named = [&](const auto& each) { return each->name == input; };
  auto& state = **std::find_if(inputs.begin(), inputs.end(), named);
  std::optional<hc::Message> message;
  check_thread();
  if (run_ != nullptr && !is_in_script_)
    raise({hc::Code::Invalid, "a handler cannot take messages in a loop"});
  if (run_ == nullptr) return message;
  work_in_loop([&] { message = run_->next(state); });
  exit_if_over();
  return message;
}

int Program::end(bool has_failed) {
  if (run_ == nullptr) return 0;
  check_thread();
  int status = 0;
  if (has_failed) run_->fail();
  work_in_loop([&] { status = run_->end(); });
  run_.reset();
  is_running_ = is_in_script_ = false;
  raise_exit();
  return status;
}

/// Ends the interpreter where a handler wants it, the module has failed, or has done what was
/// asked.
void Program::exit_if_over() {
  raise_exit();
  if (run_->has_status()) exit_by(end(false));
}

void Program::exit_by(int status) {
  PyErr_SetObject(PyExc_SystemExit, py::int_(status).ptr());
  throw py::error_already_set();
}

/// Raises the exception with which a handler has ended the interpreter.
void Program::raise_exit() {
  if (!exit_) return;
  auto error = *std::exchange(exit_, std::nullopt);
  throw py::error_already_set(error);
}

void Program::end_by_error() {
  if (failure_ != nullptr && PyErr_ExceptionMatches(stopped_type()) != 0) {
    PyErr_Clear();
    std::rethrow_exception(std::exchange(failure_, nullptr));
  }
  failure_ = nullptr;
  py::error_already_set raised;
  const auto text = py::str(raised.value()).cast<std::string>();
  if (raised.matches(bad_message_type())) throw hc::BadMessage(text);
  if (const auto name = refusal(raised); !name.empty())
    throw hc::BadMessage(name + ": " + text.substr(0, text.find('\n')) + place_of(raised));
  if (raised.matches(error_type())) {
    const py::object code = py::getattr(raised.value(), "code", py::str(""));
    throw module_error(text, py::str(code).cast<std::string>());
  }
  if (!raised.matches(PyExc_Exception)) {  // SystemExit, KeyboardInterrupt
    exit_ = raised;
    throw hc::internal::Stopped();
  }
  const auto name = py::object(raised.type().attr("__name__")).cast<std::string>();
  PyErr_Display(raised.type().ptr(), raised.value().ptr(), raised.trace().ptr());
  const std::string line = text.substr(0, text.find('\n'));  // the traceback has all lines
  throw hc::ModuleError(line.empty() ? name : name + ": " + line);
}

void Program::refuse_thread() {
  raise({hc::Code::Invalid,
         "a module, its ports and parameters may only be used on the thread that runs it; let "
         "another "
         "thread pass its data, and use them in a handler, e.g. of every()"});
}

/// Raises the failure. One that ends the module cleanly is kept for end_by_error(). A script goes
/// on, and gets no further message; its next call exits.
void Program::raise_failure() {
  try {
    std::rethrow_exception(failure_);
  } catch (...) {
    set_current_exception();
  }
  const bool is_stopped = PyErr_ExceptionMatches(stopped_type()) != 0;
  if (!is_stopped || is_in_script_) failure_ = nullptr;
  if (!is_stopped || !is_in_script_) throw py::error_already_set();
  PyErr_Clear();
  is_stopped_ = true;
  run_->stop();
}

}  // namespace python
