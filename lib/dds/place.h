// SPDX-License-Identifier: Apache-2.0
#pragma once
// The address of a DDS link. Internal.

#include <cstdint>
#include <string>
#include <vector>

#include <hc/base/result.h>
#include <hc/base/uri.h>

namespace hc::dds {

/// A parsed URI `dds:TOPIC?domain=N&interface=ADDRESS,…`.
struct Place {
  std::string topic;
  std::uint32_t domain = 0;
  std::vector<std::string> addresses;  ///< IPv4, of this host; empty: only loopback
};

/// Errors: Invalid (the topic has characters other than letters, digits, `_` and `/`, or starts
/// with a digit; an interface is not an IPv4 address).
Result<Place> parse_place(const Uri& uri);

/// The indices of the network interfaces of a place, loopback first.
///
/// Errors: NotFound (no interface that is up has the address), System.
Result<std::vector<unsigned>> find_interfaces(const Place& place);

/// The configuration of Cyclone DDS, in XML.
/// @param max_bytes  longer samples are dropped before they are reassembled.
std::string configuration(const Place& place, std::uint64_t max_bytes);

}  // namespace hc::dds
