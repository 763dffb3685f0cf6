// SPDX-License-Identifier: Apache-2.0
#pragma once
// How a module's parameters become a server.

#include <memory>
#include <string>

#include <hc/base/log.h>
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

struct Opened {
  std::unique_ptr<Server> server;
  Place place;
  std::string fingerprint;  ///< of the certificate; empty: no TLS
};

/// Whether an address is reached from this machine alone.
bool is_local(const std::string& address);

/// Listens, by TLS with the user's own certificate (load_identity()) where others reach it.
/// Errors: as Server::listen() and load_identity().
Result<Opened> open_server(const Listening& listening, LogSink log);

}  // namespace hc::web
