// SPDX-License-Identifier: Apache-2.0
#pragma once
// Where in the network a DDS link is. Internal.

#include <cstdint>
#include <string>
#include <vector>

#include <hc/base/result.h>
#include <hc/base/uri.h>

namespace hc::dds {

/// What a URI `dds:TOPIC?domain=N&interface=ADDRESS,…` names.
struct Place {
  std::string topic;
  std::uint32_t domain = 0;
  std::vector<std::string> addresses;  ///< IPv4, of this host; none: loopback alone
};

/// Errors: Invalid (a topic is letters, digits, `_` and `/`, of which a digit is not the first; an
/// interface is the IPv4 address of one).
Result<Place> parse_place(const Uri& uri);

/// The numbers of the network interfaces of a place, loopback first.
///
/// Errors: NotFound (none of this host has the address), System.
Result<std::vector<unsigned>> find_interfaces(const Place& place);

/// How Cyclone DDS is to go about it, in XML.
/// @param max_bytes  longer samples are dropped before they are put together.
std::string configuration(const Place& place, std::uint64_t max_bytes);

}  // namespace hc::dds
