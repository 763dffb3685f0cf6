// SPDX-License-Identifier: Apache-2.0
#pragma once
// For tests: messages to send and receive over links.

#include <memory>
#include <string>

#include <hc/link/link.h>
#include <hc/testing/must.h>

namespace hc {

inline std::unique_ptr<Source> source_of(const std::string& uri, const LinkOptions& options = {}) {
  return must(open_source(*parse_uri(uri), options));
}
inline std::unique_ptr<Sink> sink_of(const std::string& uri, const LinkOptions& options = {}) {
  return must(open_sink(*parse_uri(uri), options));
}

/// The next message; the end of the source ends the test.
inline Message next(Source& source) {
  Message message;
  if (!must(receive(source, message))) throw std::runtime_error("the source is at its end");
  return message;
}

}  // namespace hc
