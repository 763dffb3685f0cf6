// SPDX-License-Identifier: Apache-2.0
#include "message.h"

#include <pybind11/numpy.h>

#include <algorithm>
#include <array>
#include <new>

#include <hc/base/format.h>
#include <hc/link/link.h>
#include <hc/mtp/coords.h>
#include <hc/mtp/rows.h>

namespace python {
namespace {

constexpr int kContiguous = 0x1, kAligned = 0x100, kWriteable = 0x400;  // flags of numpy arrays

/// Fields are constructed and destroyed by hand, since Python allocates the object.
struct PyMessage {
  PyObject_HEAD hc::Message message;
  std::shared_ptr<Keeper> keeper;
  std::size_t place;   // in keeper->kept
  PyCodeObject* code;  // where its array was taken, noted once many are kept; may be null
  int line;
};

constexpr std::size_t kNotKept = static_cast<std::size_t>(-1);

PyTypeObject* message_type = nullptr;

const hc::Message& message_of(PyObject* self) {
  return reinterpret_cast<PyMessage*>(self)->message;
}

/// Notes the Python line at which a message's array is taken.
void note_line(PyMessage& self) {
  PyFrameObject* frame = PyEval_GetFrame();  // borrowed
  if (frame == nullptr || self.code != nullptr) return;
  self.code = PyFrame_GetCode(frame);
  self.line = PyFrame_GetLineNumber(frame);
}

/// Warns that too many messages are kept. False if Python turns the warning into an exception.
bool warn_kept(Keeper& keeper) {
  keeper.has_warned = true;
  Line line{py::str("<unknown>")};
  auto noted = std::find_if(keeper.kept.begin(), keeper.kept.end(), [](PyObject* each) {
    return reinterpret_cast<PyMessage*>(each)->code != nullptr;
  });
  if (noted != keeper.kept.end()) {
    const auto& first = *reinterpret_cast<PyMessage*>(*noted);
    line = {py::handle(reinterpret_cast<PyObject*>(first.code)).attr("co_filename"), first.line};
  } else if (keeper.handler != nullptr && PyObject_HasAttrString(keeper.handler, "__code__")) {
    const auto code = py::handle(keeper.handler).attr("__code__");
    line = {code.attr("co_filename"), code.attr("co_firstlineno").cast<int>()};
  } else if (keeper.handler == nullptr) {
    line = current_line().value_or(line);
  }
  const std::string text = hc::format(
      "{} messages of {} are kept in the memory of their publisher; until some are released, "
      "further ones are copied. To keep numbers, keep a copy: message.matrix.copy()",
      keeper.kept.size(), keeper.name);
  return PyErr_WarnExplicitObject(PyExc_RuntimeWarning, py::str(text).ptr(), line.file.ptr(),
                                  line.number, nullptr, nullptr) == 0;
}

hc::Message with_own_elements(const hc::Message& message) {
  hc::Message copy = message;
  copy.owner = nullptr;
  return copy.keep();
}

void end_message(PyObject* self) {
  auto& each = *reinterpret_cast<PyMessage*>(self);
  if (each.place != kNotKept) {
    auto& kept = each.keeper->kept;
    kept[each.place] = kept.back();
    reinterpret_cast<PyMessage*>(kept.back())->place = each.place;
    kept.pop_back();
  }
  Py_XDECREF(each.code);
  each.message.~Message();
  each.keeper.~shared_ptr();
  PyTypeObject* type = Py_TYPE(self);
  PyObject_Free(self);
  Py_DECREF(type);
}

/// The dtype of a scalar; a borrowed reference.
PyObject* dtype_of(hc::Scalar scalar) {
  static std::array<PyObject*, 10> types{};
  PyObject*& type = types.at(static_cast<std::size_t>(scalar));
  if (type == nullptr) {
    constexpr std::array kNames = {"u1", "i1", "u2", "i2", "u4", "i4", "u8", "i8", "f4", "f8"};
    type = py::dtype(std::string(kNames.at(static_cast<std::size_t>(scalar)))).release().ptr();
  }
  return type;
}

bool must_be_plain(const hc::Message& message) {
  if (message.plain()) return true;
  set_error(hc::Error{hc::Code::Unsupported, "the elements are compressed"});
  return false;
}

PyObject* get_matrix(PyObject* self, void*) {
  auto& each = *reinterpret_cast<PyMessage*>(self);
  if (!must_be_plain(each.message)) return nullptr;
  if (each.keeper != nullptr && each.keeper->kept.size() > Keeper::kMostKept / 4) note_line(each);
  return view_elements(each.message.header, each.message.elements.data(), false, self);
}

template <typename T>
PyObject* number(T value) {
  if constexpr (std::is_floating_point_v<T>)
    return PyFloat_FromDouble(static_cast<double>(value));
  else if constexpr (std::is_signed_v<T>)
    return PyLong_FromLongLong(value);
  else
    return PyLong_FromUnsignedLongLong(value);
}

PyObject* get_numbers(PyObject* self, void*) {
  const hc::Message& message = message_of(self);
  if (!must_be_plain(message)) return nullptr;
  return hc::visit_scalar(message.header.info.scalar, [&](auto zero) -> PyObject* {
    using T = decltype(zero);
    const std::span numbers{reinterpret_cast<const T*>(message.elements.data()),
                            message.elements.size() / sizeof(T)};
    PyObject* tuple = PyTuple_New(static_cast<Py_ssize_t>(numbers.size()));
    for (std::size_t i = 0; tuple != nullptr && i < numbers.size(); ++i) {
      PyObject* each = number(numbers[i]);
      if (each == nullptr) Py_CLEAR(tuple);
      if (tuple != nullptr) PyTuple_SET_ITEM(tuple, static_cast<Py_ssize_t>(i), each);
    }
    return tuple;
  });
}

PyObject* decode(std::string_view text) {
  return PyUnicode_DecodeUTF8(text.data(), static_cast<Py_ssize_t>(text.size()), "replace");
}

PyObject* get_text(PyObject* self, void*) {
  const hc::Message& message = message_of(self);
  if (message.header.info.type != hc::MatrixType::String) {
    set_error(hc::Error{hc::Code::Unsupported,
                        "no text: the message is a " + hc::matrix_text(message.header.info)});
    return nullptr;
  }
  if (!must_be_plain(message)) return nullptr;
  if (message.header.height <= 1) return decode(message.text());
  std::string text;
  for (const auto& row : hc::rows_of(message)) text += (text.empty() ? "" : "\n") + row;
  return decode(text);
}

PyObject* text_of(std::string_view text) {
  return PyUnicode_InternFromString(std::string(text).c_str());
}

template <auto kField>
PyObject* get_field(PyObject* self, void*) {
  return PyLong_FromLongLong(message_of(self).header.*kField);
}

PyObject* get_time(PyObject* self, void*) {
  return PyLong_FromLongLong(hc::unix_nanoseconds(message_of(self).header.time));
}
PyObject* get_components(PyObject* self, void*) {
  return PyLong_FromLong(message_of(self).header.info.components);
}
PyObject* get_type(PyObject* self, void*) {
  return text_of(hc::name(message_of(self).header.info.type));
}
PyObject* get_scalar(PyObject* self, void*) {
  return text_of(hc::name(message_of(self).header.info.scalar));
}
PyObject* get_encoding(PyObject* self, void*) {
  return text_of(hc::name(message_of(self).header.info.encoding));
}

PyObject* copy(PyObject* self, PyObject*) {
  return wrap(with_own_elements(message_of(self)), nullptr);
}

PyObject* describe(PyObject* self) {
  const hc::Header& header = message_of(self).header;
  std::string text = "<Message " + hc::matrix_text(header.info, header.width, header.height);
  if (header.coord != 0) text += " in " + hc::coord_and_number(header.coord);
  return decode(text + hc::format(", src {} seq {} at {}>", header.src, header.seq,
                                  hc::unix_nanoseconds(header.time)));
}

PyGetSetDef fields[] = {
    {"matrix", guarded<get_matrix>, nullptr,
     "The elements as a read-only numpy array without a copy: (height, width, components), or\n"
     "(height, width) for one component. An array keeps its memory alive, and a publisher lends\n"
     "few messages of shared memory: to keep elements for long, keep matrix.copy().",
     nullptr},
    {"numbers", guarded<get_numbers>, nullptr,
     "All numbers, row by row, as a tuple of Python numbers. For many numbers use matrix.",
     nullptr},
    {"text", guarded<get_text>, nullptr, "The text of a string; rows are separated by line feeds.",
     nullptr},
    {"src", guarded<get_field<&hc::Header::src>>, nullptr, "Address of the output that sent it.",
     nullptr},
    {"dst", guarded<get_field<&hc::Header::dst>>, nullptr,
     "Address of the receiver; 0: the linked inputs.", nullptr},
    {"seq", guarded<get_field<&hc::Header::seq>>, nullptr, "Counts up by one per src.", nullptr},
    {"ttl", guarded<get_field<&hc::Header::ttl>>, nullptr, "Routers left to pass.", nullptr},
    {"time", guarded<get_time>, nullptr,
     "Time of the sensed event [ns since the Unix epoch]; 0: unknown.", nullptr},
    {"mode", guarded<get_field<&hc::Header::mode>>, nullptr, "System mode of the sender; 0: none.",
     nullptr},
    {"coord", guarded<get_field<&hc::Header::coord>>, nullptr,
     "Number of the coordinate system of the elements; 0: none given.", nullptr},
    {"width", guarded<get_field<&hc::Header::width>>, nullptr, "Elements in a row.", nullptr},
    {"height", guarded<get_field<&hc::Header::height>>, nullptr, "Rows.", nullptr},
    {"components", guarded<get_components>, nullptr, "Numbers in an element.", nullptr},
    {"type", guarded<get_type>, nullptr, "Type of the matrix, such as rgb_image or table.",
     nullptr},
    {"scalar", guarded<get_scalar>, nullptr, "Type of the numbers, such as u8 or f64.", nullptr},
    {"encoding", guarded<get_encoding>, nullptr, "How it was written: text, binary, zstd or jpeg.",
     nullptr},
    {}};

PyMethodDef methods[] = {{"copy", guarded<copy>, METH_NOARGS,
                          "A copy of the message and its elements, to keep for long."},
                         {}};

PyType_Slot slots[] = {
    {Py_tp_dealloc, reinterpret_cast<void*>(end_message)},
    {Py_tp_getset, fields},
    {Py_tp_methods, methods},
    {Py_tp_repr, reinterpret_cast<void*>(guarded<describe>)},
    {Py_tp_doc, const_cast<char*>("A message: a header and an immutable matrix of numbers.")},
    {0, nullptr}};

PyType_Spec spec = {"hypercolumn.Message", sizeof(PyMessage), 0,
                    Py_TPFLAGS_DEFAULT | Py_TPFLAGS_DISALLOW_INSTANTIATION, slots};

}  // namespace

PyObject* wrap(hc::Message message, const std::shared_ptr<Keeper>& keeper) {
  const bool is_lent = keeper != nullptr && hc::is_lent(message);
  if (is_lent && keeper->kept.size() >= Keeper::kMostKept) {
    if (!keeper->has_warned && !warn_kept(*keeper)) return nullptr;
    message = with_own_elements(message);
    return wrap(std::move(message), nullptr);
  }
  if (is_lent) keeper->kept.reserve(Keeper::kMostKept);
  auto* self = PyObject_New(PyMessage, message_type);
  if (self == nullptr) return nullptr;
  new (&self->message) hc::Message(std::move(message));
  new (&self->keeper) std::shared_ptr<Keeper>();
  self->place = kNotKept;
  self->code = nullptr;
  self->line = 0;
  auto* object = reinterpret_cast<PyObject*>(self);
  if (is_lent) {
    self->keeper = keeper;
    self->place = keeper->kept.size();
    keeper->kept.push_back(object);
  }
  return object;
}

const hc::Message* message_in(PyObject* object) {
  return Py_TYPE(object) == message_type ? &message_of(object) : nullptr;
}

PyObject* view_elements(const hc::Header& header, const std::byte* elements, bool is_writable,
                        PyObject* base) {
  const auto& numpy = py::detail::npy_api::get();
  PyObject* dtype = dtype_of(header.info.scalar);
  const std::array<Py_intptr_t, 3> sides = {header.height, header.width, header.info.components};
  static std::byte nothing[8]{};  // an empty array needs an address, too
  auto* data = const_cast<std::byte*>(elements != nullptr ? elements : nothing);
  const int flags = kContiguous | kAligned | (is_writable ? kWriteable : 0);
  Py_INCREF(dtype);  // the array takes this reference
  PyObject* array =
      numpy.PyArray_NewFromDescr_(numpy.PyArray_Type_, dtype, header.info.components == 1 ? 2 : 3,
                                  sides.data(), nullptr, data, flags, nullptr);
  if (array == nullptr) return nullptr;
  Py_INCREF(base);
  if (numpy.PyArray_SetBaseObject_(array, base) != 0) Py_CLEAR(array);
  return array;
}

void add_messages(py::module_& extension) {
  message_type = reinterpret_cast<PyTypeObject*>(PyType_FromSpec(&spec));
  if (message_type == nullptr) throw py::error_already_set();
  extension.add_object("Message", reinterpret_cast<PyObject*>(message_type));
}

}  // namespace python
