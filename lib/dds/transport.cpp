// SPDX-License-Identifier: Apache-2.0
// `dds:TOPIC`: between any number of writers and readers in a network, by Cyclone DDS.
#include <dds/sink.h>
#include <dds/source.h>
#include <hc/link/transports.h>

extern "C" {
extern const int kHcDdsTransport;
const int kHcDdsTransport = 0;
}

namespace hc::internal {

Result<std::unique_ptr<Source>> open_dds_source(const Uri& uri, const LinkOptions& options) {
  auto place = dds::parse_place(uri);
  return place ? dds::make_source(*place, uri, options) : place.error();
}

Result<std::unique_ptr<Sink>> open_dds_sink(const Uri& uri, const LinkOptions& options) {
  auto place = dds::parse_place(uri);
  return place ? dds::make_sink(*place, uri, options) : place.error();
}

}  // namespace hc::internal
