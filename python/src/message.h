// SPDX-License-Identifier: Apache-2.0
#pragma once
// hypercolumn.Message: a message in Python, with numpy arrays that view its elements.

#include <cstdint>
#include <memory>
#include <vector>

#include <hc/mtp/message.h>

#include "python.h"

namespace python {

/// What of an input, or of a stream, Python keeps of the memory of a publisher, who lends a reader
/// so many messages at most (63): beyond kMostKept further ones are copied, with one warning that
/// names the line at which arrays were taken that are still there.
struct Keeper {
  static constexpr std::size_t kMostKept = 40;  // up to 16 more wait for others of their time

  std::string name;                  ///< of the input, or the stream
  PyObject* handler = nullptr;       ///< borrowed; null: a stream
  std::vector<PyObject*> kept = {};  ///< messages that live and are lent by a publisher; borrowed
  bool has_warned = false;
};

/// A Python message of its own, with the GIL. Null when Python has raised.
PyObject* wrap(hc::Message message, const std::shared_ptr<Keeper>& keeper);

/// The message in a Python object; null where it is none.
const hc::Message* message_in(PyObject* object);

/// A numpy array over elements, which `base` keeps alive: (height, width, components), without the
/// last where it is 1. Null when Python has raised.
PyObject* view_elements(const hc::Header& header, const std::byte* elements, bool is_writable,
                        PyObject* base);

}  // namespace python
