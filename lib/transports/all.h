// SPDX-License-Identifier: Apache-2.0
#pragma once
// All transports of links, for a program's main().

#include <dds/transport.h>
#include <tls/transport.h>

namespace hc {

/// Adds `tls`, `tls-listen` and `dds` to the transports that every program has, as far as OpenSSL
/// and Cyclone DDS were found when Hypercolumn was built. To be called first in main():
///
///     int main(int argc, char** argv) {
///       hc::add_all_transports();
///       hc::Module module{"twice", "Doubles numbers."};
inline void add_all_transports() {
  tls::add_transports();
  dds::add_transport();
}

}  // namespace hc
