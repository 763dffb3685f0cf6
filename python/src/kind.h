// SPDX-License-Identifier: Apache-2.0
#pragma once
// hypercolumn.Kind: what a port takes or gives.

#include <vector>

#include <hc/contract/port_type.h>

#include "python.h"

namespace python {

/// One type, or several of which an input takes any; none: anything.
struct Kind {
  std::vector<hc::PortType> types;

  /// The type of an output, or where only one makes sense. Raises when there are several or none.
  [[nodiscard]] const hc::PortType& only(const char* wanted_by) const;
};

/// The number of a coordinate system: of an int, or by its name. Raises.
std::int32_t coord_of(const py::object& coord);

}  // namespace python
