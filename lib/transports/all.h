// SPDX-License-Identifier: Apache-2.0
#pragma once
// All link transports, for main().

#include <dds/transport.h>
#include <tls/transport.h>

namespace hc {

/// Adds `tls`, `tls-listen` and `dds` to the built-in transports, if Hypercolumn was built with
/// OpenSSL and Cyclone DDS. Call first in main():
///
///     int main(int argc, char** argv) {
///       hc::add_all_transports();
///       hc::Module module{"twice", "Doubles numbers."};
inline void add_all_transports() {
  tls::add_transports();
  dds::add_transport();
}

}  // namespace hc
