// SPDX-License-Identifier: Apache-2.0
#include "kind.h"

#include <pybind11/stl.h>

#include <hc/base/suggestion.h>
#include <hc/mtp/coords.h>

namespace python {
namespace {

/// The scalar type of a name in the specification, or of anything that numpy accepts as dtype.
hc::Scalar scalar_of(const py::object& scalar) {
  if (py::isinstance<py::str>(scalar))
    if (auto found = hc::scalar_of(scalar.cast<std::string>())) return *found;
  const auto dtype = py::module_::import("numpy").attr("dtype")(scalar);
  const auto kind = dtype.attr("kind").cast<std::string>();
  const int bits = 8 * dtype.attr("itemsize").cast<int>();
  const auto found = hc::scalar_of(kind + std::to_string(bits));
  if (!found)
    raise({hc::Code::Unsupported,
           "not a scalar type of messages: " + py::str(dtype).cast<std::string>()});
  return *found;
}

/// Small messages are written as text, as in hc::Kind.
hc::Encoding encoding_of(hc::MatrixType type) {
  using hc::MatrixType;
  for (auto small : {MatrixType::Position, MatrixType::Rotation, MatrixType::String,
                     MatrixType::Transformation, MatrixType::Table})
    if (type == small) return hc::Encoding::Text;
  return hc::Encoding::Binary;
}

Kind make_kind(const std::string& type, int components, const py::object& scalar) {
  const auto matrix = hc::matrix_type_of(type);
  if (!matrix) raise({hc::Code::Invalid, "no matrix type \"" + type + "\""});
  constexpr int kMost = 99;
  if (components < 1 || components > kMost)
    raise(
        {hc::Code::Invalid, "an element has 1 … 99 components, not " + std::to_string(components)});
  const hc::Info info{*matrix, static_cast<std::uint8_t>(components), scalar_of(scalar),
                      encoding_of(*matrix)};
  if (auto wrong = hc::find_error(info))
    raise({hc::Code::Malformed, "R" + std::to_string(wrong->rule) + ": " + wrong->what});
  return {{{.info = info}}};
}

Kind with_shape(Kind kind, std::int32_t height, std::int32_t width) {
  if (height < 0 || width < 0) raise({hc::Code::Invalid, "negative shape"});
  for (auto& type : kind.types) {
    type.height = height;
    type.width = width;
  }
  return kind;
}

Kind with_coord(Kind kind, const py::object& coord) {
  for (auto& type : kind.types) type.coord = coord_of(coord);
  return kind;
}

Kind with_finite(Kind kind) {
  for (auto& type : kind.types) type.finite = true;
  return kind;
}

Kind any_of(const py::args& kinds) {
  Kind all;
  for (const auto& each : kinds) {
    const auto& types = each.cast<const Kind&>().types;
    all.types.insert(all.types.end(), types.begin(), types.end());
  }
  return all;
}

}  // namespace

const hc::PortType& Kind::only(const char* wanted_by) const {
  if (types.size() != 1)
    raise(
        {hc::Code::Invalid, std::string(wanted_by) + " has one kind, not " + hc::in_words(types)});
  return types.front();
}

std::int32_t coord_of(const py::object& coord) {
  if (!py::isinstance<py::str>(coord)) return coord.cast<std::int32_t>();
  const auto name = coord.cast<std::string>();
  const auto* found = hc::find_coord(name);
  if (found != nullptr) return found->number;
  std::vector<std::string> names;
  for (const auto& each : hc::coords()) names.emplace_back(each.name);
  raise(
      {hc::Code::NotFound, "no coordinate system \"" + name + "\"" + hc::suggestion(name, names)});
}

void add_kinds(py::module_& extension) {
  py::class_<Kind>(extension, "Kind", "The messages of a port: a type of matrix and scalar.")
      .def("of", with_shape, py::arg("height"), py::arg("width"),
           "The same with a fixed shape, so that a handler need not check it; 0: any.")
      .def("in_", with_coord, py::arg("coord"),
           "The same in a coordinate system: its name or number, or 1000 * to + from.")
      .def("finite", with_finite,
           "The same with finite numbers: an input drops and counts messages with NaN or infinity.")
      .def("__repr__", [](const Kind& kind) { return "<Kind " + hc::in_words(kind.types) + ">"; });
  extension.def("kind", make_kind);
  extension.def("any_of", any_of);
  extension.def("coords", [] {
    py::dict all;
    for (const auto& each : hc::coords()) all[py::str(std::string(each.name))] = each.number;
    return all;
  });
}

}  // namespace python
