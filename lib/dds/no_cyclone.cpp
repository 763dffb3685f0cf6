// SPDX-License-Identifier: Apache-2.0
#include <hc/link/transports.h>

extern "C" {
extern const int kHcDdsTransport;
const int kHcDdsTransport = 0;
}

namespace hc::internal {
namespace {

Error no_cyclone() {
  return {Code::Unsupported,
          "dds: links need Cyclone DDS, which this program was built without; install "
          "cyclonedds-dev and build it again"};
}

}  // namespace

Result<std::unique_ptr<Source>> open_dds_source(const Uri&, const LinkOptions&) {
  return no_cyclone();
}
Result<std::unique_ptr<Sink>> open_dds_sink(const Uri&, const LinkOptions&) {
  return no_cyclone();
}

}  // namespace hc::internal
