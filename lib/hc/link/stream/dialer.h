// SPDX-License-Identifier: Apache-2.0
#pragma once
// Connects to a peer, again and again, without blocking the caller. Internal.

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include <hc/base/backoff.h>
#include <hc/link/policy.h>
#include <hc/os/descriptor.h>
#include <hc/os/detached.h>
#include <hc/os/socket.h>

namespace hc::internal {

/// A pause between attempts, uniform between 0 and the pause of `backoff` ("full jitter"), so that
/// programs that lost the same peer do not all reconnect at once.
///
/// Source: M. Brooker, Exponential Backoff And Jitter, AWS Architecture Blog, 2015.
std::chrono::nanoseconds draw_pause(Backoff& backoff, std::minstd_rand& random);

/// Whether a connection was closed because its peer sent an invalid message.
inline bool is_bad(const Error& error) {
  return error.code != Code::Truncated && error.code != Code::Closed && error.code != Code::System;
}

constexpr std::chrono::milliseconds kFirstPause{100}, kLongestPause{5000};  // at most

/// Why a connection was lost, for the log.
inline std::string in_words(const Error& error) {
  return error.code == Code::Closed ? error.detail : error.text();
}

/// The longest pause between two attempts to connect to a peer on this host.
constexpr std::chrono::milliseconds kLocalPause{100};

/// The addresses of a name.
using Found = Result<std::vector<Address>>;

/// Where and how to connect.
struct Peer {
  std::vector<Address> addresses;  ///< tried in turn; may be empty with `find`
  std::string name;                ///< for error lines
  /// Accepts or refuses a peer that has answered; the error says why. May be empty.
  std::function<Status(int socket)> admit;
  /// Makes the secure channel of a connection, before its handshake. May be empty.
  std::function<std::unique_ptr<SecureChannel>(int socket)> secure = {};
  /// Between two attempts; short for a peer on this host, where an attempt costs little.
  std::chrono::milliseconds longest_pause = kLongestPause;
  /// Looks up a name; may block for long. Empty for a peer with fixed addresses.
  std::function<Found()> find = {};
};

/// Connects to a peer, and reconnects when the connection is lost.
///
/// After a refused attempt it pauses, for at most kAway if the network is down. After one without
/// an answer within kAnswer it tries again at once. So a network that comes back is soon in use,
/// although the kernel's own retries are seconds apart by then.
///
/// A name is looked up in the background, each time before its addresses are tried in turn: it may
/// be unknown at first, for at most kAway after it is known, and get other addresses later. Until a
/// lookup is done, or if it fails, the addresses known so far are tried.
class Dialer {
 public:
  static constexpr std::chrono::seconds kAnswer{1}, kAway{1};
  /// A connection of at least this duration counts as successful.
  static constexpr std::chrono::seconds kUseTime{1};

  /// How long the first connection may take before a warning is logged.
  static constexpr std::chrono::seconds kQuiet{1};

  /// @param first  how long to try to make the first connection.
  /// @param patience  how long to try to make each one after that.
  Dialer(Peer peer, std::chrono::seconds first, std::chrono::seconds patience, TimePoint now);

  /// Starts, continues or ends an attempt, as due. Returns the connection, or none (-1) so far.
  ///
  /// Errors: when the time is over, Closed, or NotFound if there never was a connection.
  Result<ConnectedSocket> dial(TimePoint now);
  /// The socket of the current attempt, or what is readable when the peer's name has been looked
  /// up; -1: neither.
  [[nodiscard]] int descriptor() const;
  /// The poll events that the attempt or lookup waits for.
  [[nodiscard]] short events() const { return attempt_ ? events_ : short{POLLIN}; }
  /// When to call dial() again at the latest.
  [[nodiscard]] TimePoint due() const;
  /// Whether all addresses have been tried and have refused: no peer listens.
  [[nodiscard]] bool is_refused() const { return is_refused_; }
  /// Why the last attempt failed.
  [[nodiscard]] const std::string& why() const { return why_; }

  /// Logs when the first connection takes long, when a connection is lost, and when it is back.
  void log_to(LogSink log) { log_ = std::move(log); }

  /// Tells that the connection from dial() is in use.
  void in_use();
  /// Tells that the connection is lost. The next attempt is made at once, or after a pause if the
  /// connection was not successful, so that a peer that accepts and closes each time costs no more
  /// than one that refuses. Pauses grow if the connection was shorter than the first of them.
  /// @param why  for the log, and the error when the time is over.
  /// @param log_after  logs the loss after this time, unless a connection is in use by then.
  void lost(TimePoint now, bool was_of_use, std::string why,
            std::chrono::milliseconds log_after = {});

 private:
  [[nodiscard]] bool awaits_addresses() const { return lookup_ && peer_.addresses.empty(); }
  bool has_addresses(TimePoint now);
  void try_next(TimePoint now);
  bool is_connected(TimePoint now);
  bool has_agreed(TimePoint now);
  void fail(int number, TimePoint now);
  void log_loss();
  void log(Level level, std::string_view line) const;

  Peer peer_;
  std::chrono::seconds first_, patience_;
  bool was_there_ = false;   // there has been a connection
  bool is_awaited_ = false;  // it has been logged that there is no peer yet
  std::minstd_rand random_{std::random_device{}()};
  Backoff backoff_;
  TimePoint begin_, give_up_, next_try_, connected_at_;
  std::size_t turn_ = 0;  // the address to try next
  bool is_refused_ = false, was_silent_ = false;
  std::optional<Detached<Found>> lookup_;
  ConnectedSocket attempt_;
  short events_ = POLLOUT;
  TimePoint answer_due_;
  std::string why_;  // the last attempt failed
  LogSink log_;
  std::string loss_;                      // why the last connection was lost
  TimePoint log_due_ = TimePoint::max();  // when to log it
  std::string news_;                      // logged with the next connection; may be empty
};

}  // namespace hc::internal
