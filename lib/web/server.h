// SPDX-License-Identifier: Apache-2.0
#pragma once
// An HTTP and WebSocket server, with or without TLS. Its Site decides about contents and access.
// All functions are called on the server's thread, except post() and stop(), which are thread-safe.
// Boost stays out of this header.

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <hc/base/log.h>
#include <hc/base/result.h>
#include <hc/os/descriptor.h>
#include <hc/os/loop.h>

namespace hc::web {

/// Calls a function on the server's thread, soon. Thread-safe.
using Post = std::function<void(std::function<void()>)>;

/// Work for another thread; the function it returns is called on the server's thread.
using Work = std::function<std::function<void()>()>;

/// Bytes shared by several recipients.
using Bytes = std::shared_ptr<const std::string>;

struct Request {
  std::string path;   ///< such as "/streams/eyes.left", decoded
  std::string query;  ///< behind `?`, not decoded
  std::string host, origin, cookies;
  bool is_socket = false;        ///< asks for a WebSocket
  std::string protocols;         ///< subprotocols offered for the WebSocket
  bool is_another_user = false;  ///< sent by another user of this machine, except root
};

/// The value of an option in a query; empty if missing.
std::string_view option(std::string_view query, std::string_view name);

struct Reply {
  int status = 200;  ///< below 400: the client has shown a session
  std::string type = "text/plain; charset=utf-8";
  Bytes body;                                               ///< null: none
  std::vector<std::pair<std::string, std::string>> fields;  ///< additional header fields
  Descriptor file;                                          ///< its next bytes follow the body
  std::uint64_t size = 0;  ///< of these [byte]; a shorter file breaks the connection
  /// Makes the actual reply on another thread, as with Server::aside(), if that needs a disk. If no
  /// thread is available, the reply is 503.
  std::function<Reply()> aside;
};

/// A reply with a line that says why a request is refused.
Reply refusal(int status, const std::string& words);

/// The server's end of a WebSocket; the destructor closes it.
class WebSocket {
 public:
  virtual ~WebSocket() = default;
  virtual void send_text(std::string text) = 0;
  /// @param head  bytes to send before `message`, as part of it.
  virtual void send(Bytes message, std::string head = {}) = 0;
  /// @param code  of RFC 6455, section 7.4, or from 4000 on. No callback follows.
  virtual void close(int code, std::string reason) = 0;
  /// The number of queued messages.
  [[nodiscard]] virtual std::size_t waiting() const = 0;

  std::function<void(std::string_view)> on_text, on_binary;
  /// A message has been written.
  std::function<void()> on_sent;
  /// The connection is closed or has failed.
  std::function<void()> on_close;
};

/// The contents of a server. Exceptions of its functions are logged and end only that connection.
class Site {
 public:
  virtual ~Site() = default;
  /// The reply to a GET. For a WebSocket: a refusal, or status 101 and its header fields.
  virtual Reply reply(const Request& request) = 0;
  /// Takes a WebSocket for which reply() gave 101.
  virtual void open(std::shared_ptr<WebSocket> socket, const Request& request) = 0;
  /// Disconnects all clients at the end.
  virtual void close() {}
};

class Server {
 public:
  virtual ~Server() = default;

  /// Listens; serves once run() is called.
  ///
  /// Up to 128 connections without a session are open at a time: each further one closes the oldest
  /// one of the user or host that has most of them. Connections with a session, at most 768, are
  /// never closed for others.
  ///
  /// @param port  the first of `ports` to try; 0: any free one.
  /// @param identity  a certificate and its key in PEM; empty: no TLS.
  /// Errors: Invalid (not an IP address), System (no free port; unusable identity).
  static Result<std::unique_ptr<Server>> listen(const std::string& address, std::uint16_t port,
                                                int ports, const std::string& identity,
                                                LogSink log);

  /// Before stop().
  [[nodiscard]] virtual std::uint16_t port() const = 0;
  /// Serves a site until stop().
  virtual void run(Site& site) = 0;
  /// Accepts no more clients, and answers no more requests. Ends run() after 0.2 s, so that the
  /// last messages arrive; if WebSockets are still open then, when all are closed, after 4 s at
  /// most. Thread-safe.
  virtual void stop() = 0;
  /// The loop of run()'s thread, for other tasks there.
  [[nodiscard]] virtual Loop& loop() = 0;
  /// As Loop::post(); logs exceptions. Thread-safe.
  virtual void post(std::function<void()> call) = 0;
  /// Runs work that may block, on another thread (run_aside()). It is destroyed on the server's
  /// thread, and finished before run() ends; exceptions are logged.
  ///
  /// Errors: System (no descriptor or thread left; the work is not run).
  virtual Status aside(Work work) = 0;
  /// Calls a function periodically, until the server ends. Call this before run().
  virtual void every(std::chrono::milliseconds period, std::function<void()> call) = 0;
};

}  // namespace hc::web
