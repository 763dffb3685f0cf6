// SPDX-License-Identifier: Apache-2.0
#pragma once
// The transports `tls:HOST:PORT` and `tls-listen:[HOST:]PORT`: tcp links, encrypted, whose two ends
// know each other's keys.

namespace hc::tls {

/// Adds both to those of this program, if it was built with OpenSSL; see add_transport().
void add_transports();

}  // namespace hc::tls
