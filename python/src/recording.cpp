// SPDX-License-Identifier: Apache-2.0
#include "recording.h"

#include <mcap/link.h>

namespace python {

hc::Result<std::unique_ptr<hc::Source>> open_any(const std::string& text,
                                                 const hc::LinkOptions& options) {
  if (auto recording = hc::mcap::recording_uri(text))
    return hc::mcap::read_recording(*recording, options);
  auto uri = hc::parse_uri(text);
  if (!uri) return uri.error();
  return hc::open_source(*uri, options);
}

}  // namespace python
