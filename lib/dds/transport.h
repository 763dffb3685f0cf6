// SPDX-License-Identifier: Apache-2.0
#pragma once
// The transport `dds:TOPIC`: any number of writers and readers in a network, by Cyclone DDS.

namespace hc::dds {

/// Adds it to those of this program, if it was built with Cyclone DDS; see hc::add_transport().
void add_transport();

}  // namespace hc::dds
