// SPDX-License-Identifier: Apache-2.0
#pragma once
// WebSockets of the server, over a stream with or without TLS.

#include <chrono>
#include <memory>

#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/ssl.hpp>

#include <web/server.h>
#include <web/visitor.h>

namespace hc::web {

using Plain = boost::beast::tcp_stream;
using Secure = boost::beast::ssl_stream<boost::beast::tcp_stream>;
using Head = boost::beast::http::request<boost::beast::http::empty_body>;

constexpr std::chrono::seconds kHeadTime{5};  ///< for a handshake or the head of a request

/// Answers a request for a WebSocket with the header fields of `reply`, and passes the WebSocket to
/// the site.
void accept_web_socket(Plain stream, std::shared_ptr<Visitor> visitor, Head head, Request request,
                       const Reply& reply);
void accept_web_socket(Secure stream, std::shared_ptr<Visitor> visitor, Head head, Request request,
                       const Reply& reply);

}  // namespace hc::web
