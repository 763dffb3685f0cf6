// SPDX-License-Identifier: Apache-2.0
#pragma once
// A transport, selected by the scheme of a URI. table.cpp has those of every program; main() adds
// those of other libraries, with add_all_transports() (transports/all.h).

#include <memory>
#include <string>

#include <hc/link/link.h>

namespace hc {

/// How to open the ends of links with a scheme.
struct Transport {
  std::string scheme;
  /// The options of each end, separated by spaces; URIs with others are refused.
  std::string source_options, sink_options;
  Result<std::unique_ptr<Source>> (*open_source)(const Uri& uri, const LinkOptions& options);
  Result<std::unique_ptr<Sink>> (*open_sink)(const Uri& uri, const LinkOptions& options);
  /// Checks a URI, except its options, without opening it. Errors: Invalid.
  Status (*check)(const Uri& uri);
};

/// Adds a transport, unless its scheme exists. Call it before links are opened and threads are
/// started.
void add_transport(Transport transport);

}  // namespace hc
