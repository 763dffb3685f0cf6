// SPDX-License-Identifier: Apache-2.0
#pragma once
// HTTP and WebSocket, with TLS or without; what is asked for and who may ask is its Site's affair.
// All functions are called on the server's thread, except post() and stop(), which any thread may
// call. Only server.cpp uses Beast.

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

/// Has a function called on the server's thread, soon. From any thread.
using Post = std::function<void(std::function<void()>)>;

/// Work on a thread of its own; the function it returns is called on the server's thread.
using Work = std::function<std::function<void()>()>;

/// Bytes that several are sent.
using Bytes = std::shared_ptr<const std::string>;

struct Request {
  std::string path;   ///< "/streams/eyes.left", decoded
  std::string query;  ///< behind `?`, as it came
  std::string host, origin, cookies;
  bool is_socket = false;        ///< asks for a WebSocket
  std::string protocols;         ///< of WebSockets, those that it offers
  bool is_another_user = false;  ///< its sender is another user of this machine, other than root
};

/// The value of an option in a query; empty where there is none.
std::string_view option(std::string_view query, std::string_view name);

struct Reply {
  int status = 200;  ///< below 400: who asks has shown a session
  std::string type = "text/plain; charset=utf-8";
  Bytes body;                                               ///< null: none
  std::vector<std::pair<std::string, std::string>> fields;  ///< of the head, beside the usual ones
  Descriptor file;                                          ///< its next bytes follow the body
  std::uint64_t size = 0;  ///< of these [byte]; a file that is shorter breaks the connection
  /// Makes what is answered in place of this, as Server::aside() calls it: it waits for a disk.
  /// Where that cannot be, 503 is answered.
  std::function<Reply()> aside;
};

/// A line of words that says why a request is refused.
Reply refusal(int status, const std::string& words);

/// One end of a WebSocket. Closes when it is destroyed.
class WebSocket {
 public:
  virtual ~WebSocket() = default;
  virtual void send_text(std::string text) = 0;
  /// @param head  bytes of the message before these.
  virtual void send(Bytes message, std::string head = {}) = 0;
  /// @param code  of RFC 6455, section 7.4, or from 4000 on. Nothing is called afterwards.
  virtual void close(int code, std::string reason) = 0;
  /// Messages that have not been written yet.
  [[nodiscard]] virtual std::size_t waiting() const = 0;

  std::function<void(std::string_view)> on_text, on_binary;
  /// A message has been written.
  std::function<void()> on_sent;
  /// The connection is closed or has failed.
  std::function<void()> on_close;
};

/// What a server serves.
class Site {
 public:
  virtual ~Site() = default;
  // What they throw is logged, and ends the connection that it is about alone.
  /// What is answered to a GET; of a request for a WebSocket, why it is refused, or status 101 and
  /// the fields of that answer.
  virtual Reply reply(const Request& request) = 0;
  /// A WebSocket for which reply() gave 101.
  virtual void open(std::shared_ptr<WebSocket> socket, const Request& request) = 0;
  /// Disconnects all: what they see has ended.
  virtual void close() {}
};

class Server {
 public:
  virtual ~Server() = default;

  /// Listens; serves once run() is called.
  ///
  /// @param port  the first that is tried of `ports`; 0: any that is free.
  /// @param identity  a certificate and its key, PEM; empty: no TLS.
  /// Errors: Invalid (the address is none), System (no port is free; the identity is of no use).
  /// Of connections that have not shown a session yet, 128 are served at a time: each further one
  /// closes the oldest of the user or host that has most of them. Those with a session, at most
  /// 768, never have to make room.
  static Result<std::unique_ptr<Server>> listen(const std::string& address, std::uint16_t port,
                                                int ports, const std::string& identity,
                                                LogSink log);

  [[nodiscard]] virtual std::uint16_t port() const = 0;
  /// Serves a site until stop().
  virtual void run(Site& site) = 0;
  /// Ends run() in a moment, so that what was sent last arrives. From any thread.
  virtual void stop() = 0;
  /// The loop of the thread of run(), for what else is done there.
  [[nodiscard]] virtual Loop& loop() = 0;
  /// As Loop::post(); what the function throws is logged.
  virtual void post(std::function<void()> call) = 0;
  /// Has work done that may wait, on a thread of its own (run_aside()). What it holds ends here,
  /// and it is done before run() ends; what it throws is logged.
  ///
  /// Errors: System (no descriptor or thread to be had; it is not done).
  virtual Status aside(Work work) = 0;
  /// Calls a function periodically, until it ends. To be called before run().
  virtual void every(std::chrono::milliseconds period, std::function<void()> call) = 0;
};

}  // namespace hc::web
