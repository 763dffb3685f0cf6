// SPDX-License-Identifier: Apache-2.0
// A build without zstd, and so without MCAP.
#include "recording.h"

namespace python {

hc::Result<std::unique_ptr<hc::Source>> open_any(const std::string& text,
                                                 const hc::LinkOptions& options) {
  auto uri = hc::parse_uri(text);
  if (!uri) return uri.error();
  return hc::open_source(*uri, options);
}

}  // namespace python
