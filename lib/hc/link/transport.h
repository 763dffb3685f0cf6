// SPDX-License-Identifier: Apache-2.0
#pragma once
// What the scheme of a URI opens. table.cpp has the transports that every program has; main() adds
// those of other libraries, all of them by add_all_transports() (transports/all.h).

#include <memory>
#include <string>

#include <hc/link/link.h>

namespace hc {

/// How the ends of the links of one scheme are opened.
struct Transport {
  std::string scheme;
  /// The options of each end, with blanks between; a URI with any other is refused.
  std::string source_options, sink_options;
  Result<std::unique_ptr<Source>> (*open_source)(const Uri& uri, const LinkOptions& options);
  Result<std::unique_ptr<Sink>> (*open_sink)(const Uri& uri, const LinkOptions& options);
  /// What of a URI can be checked while nothing is opened, besides its options. Errors: Invalid.
  Status (*check)(const Uri& uri);
};

/// Adds a transport to those of this program, once: before any link is opened, and before other
/// threads are started.
void add_transport(Transport transport);

}  // namespace hc
