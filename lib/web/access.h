// SPDX-License-Identifier: Apache-2.0
#pragma once
// Access control of the page (spec/page.md, W1 … W3): hosts, origins, tokens, sessions. For one
// thread.

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <hc/os/secret.h>

namespace hc::web {

/// The rights of a session; each includes those before it.
enum class Right {
  View,     ///< see everything, and stop the robot
  Drive,    ///< take the seat, and clear a stop
  Operate,  ///< change the graph, and so run any program as this user
};

/// "view", "drive" or "operate".
std::string_view name_of(Right right);
/// nullopt: no such right.
std::optional<Right> right_named(std::string_view name);

/// The address of a server.
struct Place {
  std::string address = "127.0.0.1";  ///< on which it listens
  std::uint16_t port = 0;
  bool is_secure = false;          ///< by TLS
  std::vector<std::string> hosts;  ///< further names allowed in `Host`
};

class Access {
 public:
  /// @param key  signs sessions, which are valid for all processes with the same key and port.
  explicit Access(Place place, std::string key = run_secret())
      : place_(std::move(place)), key_(std::move(key)) {}

  /// Whether a `Host` header names this server; protects against DNS rebinding. Allowed are
  /// `hosts`, the names of loopback and, unless the server listens on loopback, any IP address.
  [[nodiscard]] bool is_host(std::string_view host) const;

  /// Whether an `Origin` header is that of a page served as `host`.
  [[nodiscard]] bool is_origin(std::string_view origin, std::string_view host) const;

  /// A new token, valid once. Above 64 tokens, the oldest is forgotten.
  std::string make_token(Right right);
  /// A URL with a new token.
  std::string invite(Right right);

  /// Begins a session, which lasts until the end of the run; nullopt for a wrong or used token.
  /// @returns  the value of the session's cookie, cookie_name().
  std::optional<std::string> redeem(std::string_view token);

  /// The URL of a WebSocket with the name of a new session, for clients without cookies.
  std::string invite_socket(Right right);
  /// The right of a session, by its name; nullopt if there is no such session.
  [[nodiscard]] std::optional<Right> right_of_session(std::string_view name) const;

  /// The right of the session in a `Cookie` header; nullopt if there is none.
  [[nodiscard]] std::optional<Right> right_of(std::string_view cookies) const;

  /// The name of the cookie. It contains the port, since browsers share cookies between the ports
  /// of a host.
  [[nodiscard]] std::string cookie_name() const {
    return "hypercolumn_" + std::to_string(place_.port);
  }
  [[nodiscard]] const Place& place() const { return place_; }

 private:
  /// Host and port as in a URL, such as "127.0.0.1:8470".
  [[nodiscard]] std::string authority() const;
  /// @returns  its name.
  std::string begin_session(Right right);
  /// The signature of a session's name, valid for this port only.
  [[nodiscard]] std::string sign(std::string_view begin) const;

  Place place_;
  std::string key_;
  std::deque<std::pair<std::string, Right>> tokens_;  // newest last
};

/// Whether an address or name in a URL is reachable from this machine only.
bool is_local(std::string_view name);

/// The first IPv4 address of this machine that others can reach; 127.0.0.1 if none.
std::string own_address();

}  // namespace hc::web
