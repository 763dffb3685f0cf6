// SPDX-License-Identifier: Apache-2.0
#pragma once
// Who may see the page, drive and operate (spec/page.md, W1 … W3): hosts, origins, tokens and
// sessions. For one thread.

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

/// What a session may; each includes those before it.
enum class Right {
  View,     ///< see everything, and stop the robot
  Drive,    ///< take the seat, and clear a stop
  Operate,  ///< change the graph, and so run any program as this user
};

/// "view", "drive" or "operate".
std::string_view name_of(Right right);
/// Nothing: there is no such right.
std::optional<Right> right_named(std::string_view name);

/// Where the server is reached.
struct Place {
  std::string address = "127.0.0.1";  ///< that it listens on
  std::uint16_t port = 0;
  bool is_secure = false;          ///< by TLS
  std::vector<std::string> hosts;  ///< further names by which it may be called
};

class Access {
 public:
  /// @param key  signs sessions: one of the same key and port knows those of another process.
  explicit Access(Place place, std::string key = run_secret())
      : place_(std::move(place)), key_(std::move(key)) {}

  /// Whether a `Host` header means this server, and not a name that somebody has pointed at it.
  /// On loopback these are loopback's names; elsewhere any address, since only names can be
  /// pointed, and `hosts`.
  [[nodiscard]] bool is_host(std::string_view host) const;

  /// Whether an `Origin` header is that of the page that `host` was asked for.
  [[nodiscard]] bool is_origin(std::string_view origin, std::string_view host) const;

  /// A new token, which counts once. Of more than 64 the oldest is forgotten.
  std::string make_token(Right right);
  /// A URL with a new token.
  std::string invite(Right right);

  /// Begins a session, which ends with the run; nothing for a wrong or used token.
  /// @returns  the value of the session's cookie, cookie_name().
  std::optional<std::string> redeem(std::string_view token);

  /// A URL of a WebSocket with the name of a new session, for clients that keep no cookies.
  std::string invite_socket(Right right);
  /// What a session may do, by its name; nothing where there is none.
  [[nodiscard]] std::optional<Right> right_of_session(std::string_view name) const;

  /// What the session of a `Cookie` header may do; nothing where it has none.
  [[nodiscard]] std::optional<Right> right_of(std::string_view cookies) const;

  /// The name of the cookie; ports have their own, since cookies are the same for all ports of a
  /// host.
  [[nodiscard]] std::string cookie_name() const {
    return "hypercolumn_" + std::to_string(place_.port);
  }
  [[nodiscard]] const Place& place() const { return place_; }

 private:
  /// Where the server is reached, as in a URL: "127.0.0.1:8470".
  [[nodiscard]] std::string authority() const;
  /// @returns  its name.
  std::string begin_session(Right right);
  /// The end of the name of a session of this server, and of no other of the run.
  [[nodiscard]] std::string sign(std::string_view begin) const;

  Place place_;
  std::string key_;
  std::deque<std::pair<std::string, Right>> tokens_;  // the newest last
};

/// Whether an address or name, as URLs have it, is reached from this machine alone.
bool is_local(std::string_view name);

/// The first address by which other machines reach this one, IPv4; 127.0.0.1 where there is none.
std::string own_address();

}  // namespace hc::web
