// SPDX-License-Identifier: Apache-2.0
#pragma once
// A server with the thread that runs it, beside a module's own.

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
  int port = 0;                       ///< the next nine are tried too; 0: any
  bool tls = false;                   ///< on loopback too; elsewhere always
  std::string hosts;                  ///< further names of this machine, between commas or blanks
};

/// Listens for HTTP and WebSockets, and serves a site on a thread of its own. For the module's
/// thread; server().post() from any.
class Service {
 public:
  /// Listens, by TLS with the user's own certificate (load_identity()) where others reach it;
  /// serves once there is something to serve().
  ///
  /// @param loop  of the module's thread; it lives longer.
  /// @param log  called in the loop with lines of the server.
  /// Errors: as Server::listen() and load_identity().
  static Result<std::unique_ptr<Service>> open(const Listening& listening, Loop& loop,
                                               std::function<void(std::string_view)> log);
  /// Closes the site, and waits a moment until what was sent last has arrived.
  ~Service();
  Service(const Service&) = delete;
  Service& operator=(const Service&) = delete;

  /// Serves a site until the end, on a thread of its own, to which access() belongs from then on.
  /// To be called once.
  template <std::derived_from<Site> S>
  S& serve(std::unique_ptr<S> site) {
    S& kept = *site;
    run(std::move(site));
    return kept;
  }

  [[nodiscard]] Server& server() { return *server_; }
  [[nodiscard]] Access& access() { return access_; }
  /// Of the certificate; empty: no TLS.
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
  std::unique_ptr<Site> site_;  // destroyed before the server, to which it may still post
  std::thread thread_;
};

}  // namespace hc::web
