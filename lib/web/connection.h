// SPDX-License-Identifier: Apache-2.0
#pragma once
// Connections of the server that speak HTTP.

#include <memory>

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ssl/context.hpp>

#include <web/visitor.h>

namespace hc::web {

/// Serves requests of a client until one asks for a WebSocket or the connection ends.
///
/// @param tls  null: no TLS; must outlive the connection.
void serve(boost::asio::ip::tcp::socket socket, boost::asio::ssl::context* tls,
           std::shared_ptr<Visitor> visitor);

}  // namespace hc::web
