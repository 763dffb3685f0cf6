// SPDX-License-Identifier: Apache-2.0
#pragma once
// hypercolumn.Kind: the messages that a port accepts or sends.

#include <vector>

#include <hc/contract/port_type.h>

#include "python.h"

namespace python {

/// One type, or several alternatives for an input; none: anything.
struct Kind {
  std::vector<hc::PortType> types;

  /// The only type, e.g. of an output. Raises if there are several or none.
  [[nodiscard]] const hc::PortType& only(const char* wanted_by) const;
};

/// The number of a coordinate system, given by number or name. Raises.
std::int32_t coord_of(const py::object& coord);

}  // namespace python
