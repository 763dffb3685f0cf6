// SPDX-License-Identifier: Apache-2.0
#include "output.h"

#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <new>
#include <optional>
#include <utility>

#include <hc/base/format.h>
#include <hc/module/module.h>

#include "kind.h"
#include "message.h"

namespace python {
namespace {

/// Fields are constructed and destroyed by hand, since Python allocates the object.
struct PyOutput {
  PyObject_HEAD Program* program;
  std::shared_ptr<hc::internal::OutputState> state;
  PyObject* owner;
};

PyTypeObject* output_type = nullptr;

PyOutput& output_of(PyObject* self) {
  return *reinterpret_cast<PyOutput*>(self);
}

/// A new message, whose elements may still be written.
hc::Message make_message(const PyOutput& self, std::int32_t height, std::int32_t width) {
  self.program->check_thread();
  hc::Header header;
  header.info = self.state->type().info;
  header.height = height;
  header.width = width;
  raise_if_failed(hc::check(header));
  // loan() does not depend on the kind in the type of Output.
  return hc::Output<hc::TableKind<double>>(self.state).loan(height, width).finish();
}

std::byte* elements_of(const hc::Message& message) {
  return const_cast<std::byte*>(message.elements.data());
}

[[noreturn]] void raise_misfit(const PyOutput& self, const std::string& what) {
  raise({hc::Code::Malformed,
         self.state->name + ": " + what + "; it sends " + hc::in_words(self.state->type())});
}

/// A message for a number of numbers: of the port's shape if it has one, else one row.
hc::Message make_for_numbers(const PyOutput& self, std::size_t count) {
  const auto shape = hc::shape_of(self.state->type(), count);
  if (!shape) raise_misfit(self, std::to_string(count) + " numbers");
  return make_message(self, shape->first, shape->second);
}

/// Converts a Python number. Raises if it does not fit.
template <typename T>
T number_of(PyObject* object) {
  if constexpr (std::is_floating_point_v<T>) {
    const double value = PyFloat_AsDouble(object);
    if (value == -1.0 && PyErr_Occurred() != nullptr) throw py::error_already_set();
    return static_cast<T>(value);
  } else {
    const auto index = py::reinterpret_steal<py::object>(PyNumber_Index(object));
    if (!index) throw py::error_already_set();
    const auto wide = [&] {
      if constexpr (std::is_signed_v<T>)
        return PyLong_AsLongLong(index.ptr());
      else
        return PyLong_AsUnsignedLongLong(index.ptr());
    }();
    if (PyErr_Occurred() != nullptr || !std::in_range<T>(wide)) {
      PyErr_Clear();
      raise({hc::Code::Malformed, "R28: " + py::str(index).cast<std::string>() +
                                      " does not fit into " +
                                      std::string(hc::name(hc::scalar_for<T>()))});
    }
    return static_cast<T>(wide);
  }
}

/// A message of numbers, row by row; nothing if one is not a number, but e.g. a row.
std::optional<hc::Message> message_of_numbers(const PyOutput& self, PyObject* const* objects,
                                              std::size_t count) {
  for (std::size_t i = 0; i < count; ++i)
    if (PyFloat_CheckExact(objects[i]) == 0 && PyLong_CheckExact(objects[i]) == 0 &&
        (PySequence_Check(objects[i]) != 0 || PyNumber_Check(objects[i]) == 0))
      return std::nullopt;
  hc::Message message = make_for_numbers(self, count);
  hc::visit_scalar(message.header.info.scalar, [&](auto zero) {
    using T = decltype(zero);
    auto* to = reinterpret_cast<T*>(elements_of(message));
    for (std::size_t i = 0; i < count; ++i) to[i] = number_of<T>(objects[i]);
  });
  return message;
}

hc::Message message_of_text(const PyOutput& self, const char* text, Py_ssize_t size) {
  if (self.state->type().info.type != hc::MatrixType::String) raise_misfit(self, "a text");
  hc::Message message = make_message(self, 1, static_cast<std::int32_t>(size));
  std::memcpy(elements_of(message), text, static_cast<std::size_t>(size));
  return message;
}

/// A message from anything that numpy converts to an array. Missing leading axes have size 1.
hc::Message message_of_array(const PyOutput& self, PyObject* object) {
  static PyObject* as_array =
      py::object(py::module_::import("numpy").attr("asarray")).release().ptr();
  static PyObject* copy_to =
      py::object(py::module_::import("numpy").attr("copyto")).release().ptr();
  const auto array = py::reinterpret_steal<py::object>(PyObject_CallOneArg(as_array, object));
  if (!array) throw py::error_already_set();
  const py::tuple shape = array.attr("shape");
  const auto& info = self.state->type().info;
  std::vector<py::ssize_t> sides;
  for (const auto& side : shape) sides.push_back(side.cast<py::ssize_t>());
  if (info.components == 1 && !(sides.size() == 3 && sides.back() == 1)) sides.push_back(1);
  while (sides.size() < 3) sides.insert(sides.begin(), 1);
  // A one-dimensional array may contain several elements.
  const bool is_row = shape.size() == 1 && info.components > 1;
  if (is_row && sides[2] % info.components == 0)
    sides = {1, sides[2] / info.components, info.components};
  constexpr py::ssize_t kMost = std::numeric_limits<std::int32_t>::max();
  if (sides.size() > 3 || sides[2] != info.components || sides[0] > kMost || sides[1] > kMost)
    raise_misfit(self, "an array of shape " + py::str(py::object(shape)).cast<std::string>());
  const auto& type = self.state->type();
  const auto count = static_cast<std::size_t>(sides[0] * sides[1] * sides[2]);
  hc::Message message = shape.size() < 2 && (type.width != 0 || type.height != 0)
                            ? make_for_numbers(self, count)
                            : make_message(self, static_cast<std::int32_t>(sides[0]),
                                           static_cast<std::int32_t>(sides[1]));
  auto to = py::reinterpret_steal<py::object>(
      view_elements(message.header, elements_of(message), true, Py_None));
  if (!to) throw py::error_already_set();
  const auto from = array.attr("reshape")(to.attr("shape"));
  const auto copied = py::reinterpret_steal<py::object>(
      PyObject_CallFunctionObjArgs(copy_to, to.ptr(), from.ptr(), nullptr));
  if (copied) return message;
  if (PyErr_ExceptionMatches(PyExc_TypeError) == 0) throw py::error_already_set();
  PyErr_Clear();
  raise_misfit(self, "an array of " + py::str(array.attr("dtype")).cast<std::string>() +
                         ", to be converted by astype()");
}

hc::Message message_of(const PyOutput& self, PyObject* object) {
  if (const hc::Message* message = message_in(object)) return *message;
  if (PyList_CheckExact(object) != 0 || PyTuple_CheckExact(object) != 0) {
    // Copied, since converting an object to a number may change a list.
    const auto tuple = py::reinterpret_steal<py::object>(PySequence_Tuple(object));
    if (!tuple) throw py::error_already_set();
    auto numbers = message_of_numbers(self, PySequence_Fast_ITEMS(tuple.ptr()),
                                      static_cast<std::size_t>(PyTuple_GET_SIZE(tuple.ptr())));
    if (numbers) return std::move(*numbers);
  }
  if (PyFloat_CheckExact(object) != 0 || PyLong_CheckExact(object) != 0)
    return *message_of_numbers(self, &object, 1);
  if (PyUnicode_Check(object) != 0) {
    Py_ssize_t size = 0;
    const char* text = PyUnicode_AsUTF8AndSize(object, &size);
    if (text == nullptr) throw py::error_already_set();
    return message_of_text(self, text, size);
  }
  if (PyBytes_Check(object) != 0)
    return message_of_text(self, PyBytes_AS_STRING(object), PyBytes_GET_SIZE(object));
  return message_of_array(self, object);
}

/// Header fields that a sender may set.
struct Fields {
  const char* method;  // for errors
  PyObject *time = nullptr, *dst = nullptr, *mode = nullptr, *coord = nullptr;

  void take(PyObject* name, PyObject* value) {
    for (auto [known, field] : {std::pair{"time", &time}, std::pair{"dst", &dst},
                                std::pair{"mode", &mode}, std::pair{"coord", &coord}})
      if (PyUnicode_CompareWithASCIIString(name, known) == 0) {
        *field = value;
        return;
      }
    throw py::type_error(std::string(method) + " has time, dst, mode and coord, not " +
                         py::str(name).cast<std::string>());
  }
  void set(hc::Header& header) const {
    if (time != nullptr) header.time = hc::unix_time(py::handle(time).cast<std::int64_t>());
    if (dst != nullptr) header.dst = py::handle(dst).cast<std::int32_t>();
    if (mode != nullptr) header.mode = py::handle(mode).cast<std::int32_t>();
    if (coord != nullptr) header.coord = coord_of(py::reinterpret_borrow<py::object>(coord));
  }
};

void check_for(const PyOutput& self, const hc::Header& header) {
  const hc::PortType& type = self.state->type();
  if (!hc::fits(header, type)) {
    auto error = hc::misfit(header, type);
    raise({error.code, self.state->name + ": " + error.detail});
  }
  raise_if_failed(hc::check(header));
}

/// The result of `make`. Adds the Python line to its errors, since they end without a traceback.
template <typename Make>
hc::Message with_line(const Make& make) {
  try {
    return make();
  } catch (py::error_already_set& error) {
    const auto line = current_line();
    if (!line || !error.matches(error_type())) throw;
    const auto code = py::str(error.value().attr("code")).cast<std::string>();
    set_error(hc::format("{} ({}, line {})", py::str(error.value()).cast<std::string>(),
                         line->file_name(), line->number),
              code);
  }
  throw py::error_already_set();
}

void send_message(const PyOutput& self, hc::Message message) {
  self.program->work("send()", [&] { hc::internal::send(*self.state, std::move(message)); });
}

PyObject* send(PyObject* object, PyObject* const* arguments, Py_ssize_t count, PyObject* names) {
  if (count != 1) throw py::type_error("send() takes one message, array, or number");
  Fields fields{"send()"};
  for (Py_ssize_t i = 0; names != nullptr && i < PyTuple_GET_SIZE(names); ++i)
    fields.take(PyTuple_GET_ITEM(names, i), arguments[count + i]);
  auto& self = output_of(object);
  send_message(self, with_line([&] {
                 hc::Message message = message_of(self, arguments[0]);
                 fields.set(message.header);
                 check_for(self, message.header);
                 return message;
               }));
  Py_RETURN_NONE;
}

/// A message written in place: a context that returns its array, and sends it at the end.
class Loan {
 public:
  Loan(py::object output, hc::Message message)
      : output_(std::move(output)), message_(std::move(message)) {}

  py::object enter() {
    if (array_ || is_done_) raise({hc::Code::Invalid, "a loan can be used in one `with` only"});
    // Arrays keep the memory alive.
    py::capsule base(new std::shared_ptr<const void>(message_.owner),
                     [](void* owner) { delete static_cast<std::shared_ptr<const void>*>(owner); });
    array_ = py::reinterpret_steal<py::object>(
        view_elements(message_.header, elements_of(message_), true, base.ptr()));
    if (!array_) throw py::error_already_set();
    return array_;
  }

  void exit(const py::object& type, const py::object&, const py::object&) {
    if (array_) array_.attr("flags").attr("writeable") = false;
    array_ = {};
    hc::Message message = std::exchange(message_, {});
    if (!std::exchange(is_done_, true) && type.is_none())
      send_message(output_of(output_.ptr()), std::move(message));
  }

 private:
  py::object output_, array_;
  hc::Message message_;
  bool is_done_ = false;
};

Loan loan(const py::object& self, std::optional<std::int32_t> height,
          std::optional<std::int32_t> width, const py::kwargs& given) {
  const auto& output = output_of(self.ptr());
  const auto& type = output.state->type();
  Fields fields{"loan()"};
  for (const auto& [name, value] : given) fields.take(name.ptr(), value.ptr());
  return {self, with_line([&] {
            hc::Message message =
                make_message(output, height.value_or(type.height), width.value_or(type.width));
            fields.set(message.header);
            check_for(output, message.header);
            return message;
          })};
}

void end_output(PyObject* self) {
  output_of(self).state.~shared_ptr();
  Py_DECREF(output_of(self).owner);
  PyTypeObject* type = Py_TYPE(self);
  PyObject_Free(self);
  Py_DECREF(type);
}

PyObject* get_linked(PyObject* self, void*) {
  output_of(self).program->check_thread();
  const bool linked = hc::Output<hc::TableKind<double>>(output_of(self).state).linked();
  return PyBool_FromLong(static_cast<long>(linked));
}

PyObject* get_name(PyObject* self, void*) {
  return PyUnicode_FromString(output_of(self).state->name.c_str());
}

constexpr const char* kLoanDoc =
    "A message to write in place, in the memory of its readers. It is sent at the end of the "
    "with;\n"
    "an exception drops it.\n\n"
    "    with output.loan(600, 800) as pixels:\n"
    "        pixels[:] = 0\n\n"
    "time, dst, mode and coord are as in send(). Afterwards the array is read-only; slices taken "
    "in\n"
    "the with are not, and must not be written any more.";

PyMethodDef methods[] = {
    {"send", reinterpret_cast<PyCFunction>(reinterpret_cast<void*>(guarded<send>)),
     METH_FASTCALL | METH_KEYWORDS,
     "send(message, *, time=…, dst=…, mode=…, coord=…)\n\n"
     "Sends a number, numbers row by row, a text, an array of shape (height, width, components) "
     "or\n"
     "(height, width), or a received message. Header fields not given are filled in; the time is\n"
     "that of the message being handled. Returns when each link has accepted the message."},
    {}};

PyGetSetDef fields[] = {
    {"linked", guarded<get_linked>, nullptr, "Whether the output has a reader.", nullptr},
    {"name", guarded<get_name>, nullptr, "Its name.", nullptr},
    {}};

PyType_Slot slots[] = {{Py_tp_dealloc, reinterpret_cast<void*>(end_output)},
                       {Py_tp_methods, methods},
                       {Py_tp_getset, fields},
                       {Py_tp_doc, const_cast<char*>("An output port.")},
                       {0, nullptr}};

PyType_Spec spec = {"hypercolumn.Output", sizeof(PyOutput), 0,
                    Py_TPFLAGS_DEFAULT | Py_TPFLAGS_DISALLOW_INSTANTIATION, slots};

}  // namespace

py::object make_output(Program& program, std::shared_ptr<hc::internal::OutputState> state,
                       const py::object& owner) {
  auto* self = PyObject_New(PyOutput, output_type);
  if (self == nullptr) throw py::error_already_set();
  self->program = &program;
  new (&self->state) std::shared_ptr<hc::internal::OutputState>(std::move(state));
  self->owner = owner.inc_ref().ptr();
  return py::reinterpret_steal<py::object>(reinterpret_cast<PyObject*>(self));
}

void add_outputs(py::module_& extension) {
  output_type = reinterpret_cast<PyTypeObject*>(PyType_FromSpec(&spec));
  if (output_type == nullptr) throw py::error_already_set();
  extension.add_object("Output", reinterpret_cast<PyObject*>(output_type));
  py::class_<Loan>(extension, "Loan", "A message written in place, returned by Output.loan().")
      .def("__enter__", &Loan::enter)
      .def("__exit__", &Loan::exit);
  const py::cpp_function method(loan, py::is_method(extension.attr("Output")), py::name("loan"),
                                py::doc(kLoanDoc), py::arg("height") = py::none(),
                                py::arg("width") = py::none());
  extension.attr("Output").attr("loan") = method;
}

}  // namespace python
