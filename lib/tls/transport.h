// SPDX-License-Identifier: Apache-2.0
#pragma once
// The transports `tls:HOST:PORT` and `tls-listen:[HOST:]PORT`: encrypted TCP links whose ends
// authenticate each other by their keys.

namespace hc::tls {

/// Adds both transports to this program, if it was built with OpenSSL; see add_transport().
void add_transports();

}  // namespace hc::tls
