// SPDX-License-Identifier: Apache-2.0
// Compiled instead of the other files if Cyclone DDS was not found.
#include <dds/transport.h>

namespace hc::dds {

void add_transport() {}

}  // namespace hc::dds
