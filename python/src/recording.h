// SPDX-License-Identifier: Apache-2.0
#pragma once
// Where a script reads: links as the library has them, and recordings in other formats.

#include <memory>
#include <string>

#include <hc/link/link.h>

namespace python {

/// Opens what a URI names, a recording in MCAP too. Errors: Invalid,
/// those of hc::open_source().
hc::Result<std::unique_ptr<hc::Source>> open_any(const std::string& text,
                                                 const hc::LinkOptions& options);

}  // namespace python
