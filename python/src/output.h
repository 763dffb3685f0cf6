// SPDX-License-Identifier: Apache-2.0
#pragma once
// hypercolumn.Output: an output port in Python.

#include <memory>

#include <hc/module/port.h>

#include "program.h"

namespace python {

/// The Python object of an output; keeps `owner`, the Python module, alive.
py::object make_output(Program& program, std::shared_ptr<hc::internal::OutputState> state,
                       const py::object& owner);

}  // namespace python
