// SPDX-License-Identifier: Apache-2.0
#pragma once
// A server with its own thread, for use in a module.

#include <concepts>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <thread>
#include <utility>

#include <hc/base/result.h>
#include <web/access.h>
#include <web/server.h>

namespace hc::web {

struct Listening {
  std::string address = "127.0.0.1";  ///< IP, or localhost
  int port = 0;                       ///< or one of the next nine; 0: any
  bool tls = false;                   ///< even on loopback; other addresses always use TLS
  std::string hosts;                  ///< further names of this machine, comma- or space-separated
};

/// Serves a site over HTTP and WebSockets on its own thread. Used on the module's thread, except
/// for server().post().
class Service {
 public:
  /// Listens, on other addresses than loopback with TLS and the user's certificate
  /// (load_identity()). Requests wait until serve() is called.
  ///
  /// @param loop  of the module's thread; must outlive the service.
  /// @param log  called in the loop with log lines of the server.
  /// Errors: as Server::listen() and load_identity().
  static Result<std::unique_ptr<Service>> open(const Listening& listening, Loop& loop,
                                               std::function<void(std::string_view)> log);
  /// Closes the site and stops the server, which takes 0.2 s, and with slow clients 4 s at most.
  ~Service();
  Service(const Service&) = delete;
  Service& operator=(const Service&) = delete;

  /// Serves a site until the end. Call this once; then use access() on the server's thread only.
  template <std::derived_from<Site> S>
  S& serve(std::unique_ptr<S> site) {
    S& kept = *site;
    run(std::move(site));
    return kept;
  }

  [[nodiscard]] Server& server() { return *server_; }
  [[nodiscard]] Access& access() { return access_; }
  /// The fingerprint of the certificate; empty: no TLS.
  [[nodiscard]] const std::string& fingerprint() const { return fingerprint_; }

 private:
  Service(std::unique_ptr<Server> server, Place place, std::string fingerprint)
      : server_(std::move(server)),
        access_(std::move(place)),
        fingerprint_(std::move(fingerprint)) {}
  void run(std::unique_ptr<Site> site);

  std::unique_ptr<Server> server_;
  Access access_;
  const std::string fingerprint_;
  std::unique_ptr<Site> site_;  // may post to the server until it is destroyed
  std::thread thread_;
};

}  // namespace hc::web
