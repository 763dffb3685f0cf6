// SPDX-License-Identifier: Apache-2.0
#include "program.h"

#include <hc/module/loop.h>

namespace python {

Function hold(const py::object& function) {
  return {function.inc_ref().ptr(), [](PyObject* held) {
            if (Py_IsInitialized() == 0) return;
            const PyGILState_STATE state = PyGILState_Ensure();
            Py_DECREF(held);
            PyGILState_Release(state);
          }};
}

int Program::run(const std::vector<std::string>& words) {
  if (is_running_) raise({hc::Code::Invalid, "the module runs already"});
  std::vector<std::string> copies = words;
  std::vector<char*> pointers;
  pointers.reserve(copies.size() + 1);
  for (auto& word : copies) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  int status = 0;
  is_running_ = true;
  thread_ = std::this_thread::get_id();
  thread_state_ = PyEval_SaveThread();
  std::exception_ptr thrown;
  try {
    status = module.run(static_cast<int>(copies.size()), pointers.data());
  } catch (...) {
    thrown = std::current_exception();
  }
  PyEval_RestoreThread(thread_state_);
  thread_state_ = nullptr;
  is_running_ = false;
  failure_ = nullptr;
  if (thrown) std::rethrow_exception(thrown);
  if (exit_type_) {
    PyErr_Restore(exit_type_.release().ptr(), exit_value_.release().ptr(),
                  exit_trace_.release().ptr());
    throw py::error_already_set();
  }
  return status;
}

void Program::end_by_error() {
  if (failure_ != nullptr && PyErr_ExceptionMatches(stopped_type()) != 0) {
    PyErr_Clear();
    std::rethrow_exception(std::exchange(failure_, nullptr));
  }
  failure_ = nullptr;
  PyObject *type = nullptr, *value = nullptr, *trace = nullptr;
  PyErr_Fetch(&type, &value, &trace);
  PyErr_NormalizeException(&type, &value, &trace);
  if (trace != nullptr) PyException_SetTraceback(value, trace);
  const auto own_type = py::reinterpret_steal<py::object>(type);
  const auto own_value = py::reinterpret_steal<py::object>(value);
  const auto own_trace = py::reinterpret_steal<py::object>(trace);
  const auto text = py::str(own_value).cast<std::string>();
  if (PyErr_GivenExceptionMatches(type, error_type()) != 0) {
    hc::ModuleError error(text);
    const py::object code = py::getattr(own_value, "code", py::str(""));
    error.is_usage = py::str(code).cast<std::string>() == hc::name(hc::Code::Invalid);
    throw error;
  }
  if (PyErr_GivenExceptionMatches(type, PyExc_Exception) == 0) {  // SystemExit, KeyboardInterrupt
    exit_type_ = own_type;
    exit_value_ = own_value;
    exit_trace_ = own_trace;
    throw hc::internal::Stopped();
  }
  PyErr_Display(own_type.ptr(), own_value.ptr(), own_trace.ptr());
  const auto name = own_type.attr("__name__").cast<std::string>();
  const std::string line = text.substr(0, text.find('\n'));  // the traceback has all of them
  throw hc::ModuleError(line.empty() ? name : name + ": " + line);
}

bool Program::refuse_thread() {
  set_error(hc::Error{hc::Code::Invalid,
                      "a module is used on the thread that runs it; let another one hand over what "
                      "it has, and send that from a handler, such as of every()"});
  return false;
}

/// Raises the failure, and keeps what ends the module cleanly: it comes out in end_by_error().
bool Program::raise_failure() {
  try {
    std::rethrow_exception(failure_);
  } catch (...) {
    set_current_exception();
  }
  if (PyErr_ExceptionMatches(stopped_type()) == 0) failure_ = nullptr;
  return false;
}

}  // namespace python
