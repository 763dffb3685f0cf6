// SPDX-License-Identifier: Apache-2.0
#pragma once
// hypercolumn.Message: a message in Python, with numpy views of its elements.

#include <cstdint>
#include <memory>
#include <vector>

#include <hc/mtp/message.h>

#include "python.h"

namespace python {

/// The messages of an input or stream that Python keeps in a publisher's memory. A publisher lends
/// a reader at most 63; beyond kMostKept, further ones are copied, with one warning that names the
/// line at which a kept array was taken.
struct Keeper {
  static constexpr std::size_t kMostKept = 40;  // up to 16 more wait to be synchronised

  std::string name;                  ///< of the input, or the stream
  PyObject* handler = nullptr;       ///< borrowed; null: a stream
  std::vector<PyObject*> kept = {};  ///< live messages lent by a publisher; borrowed
  bool has_warned = false;
};

/// A new Python message; needs the GIL. Null if Python has raised.
PyObject* wrap(hc::Message message, const std::shared_ptr<Keeper>& keeper);

/// The message in a Python object; null if it is not a message.
const hc::Message* message_in(PyObject* object);

/// A numpy view of elements, which `base` keeps alive: (height, width, components), or (height,
/// width) for one component. Null if Python has raised.
PyObject* view_elements(const hc::Header& header, const std::byte* elements, bool is_writable,
                        PyObject* base);

}  // namespace python
