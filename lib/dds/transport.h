// SPDX-License-Identifier: Apache-2.0
#pragma once
// The transport `dds:TOPIC`: any number of writers and readers in a network, with Cyclone DDS.

namespace hc::dds {

/// Adds the transport to this program, if it was built with Cyclone DDS; see hc::add_transport().
void add_transport();

}  // namespace hc::dds
