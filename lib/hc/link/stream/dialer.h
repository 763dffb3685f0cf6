// SPDX-License-Identifier: Apache-2.0
#pragma once
// Connects to a peer, again and again, without blocking the caller. Internal.

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <hc/base/backoff.h>
#include <hc/link/policy.h>
#include <hc/os/descriptor.h>
#include <hc/os/socket.h>

namespace hc::internal {

/// A pause between tries, so that many that lost the same peer do not all reconnect at once:
/// uniform between 0 and the pause of `backoff` ("full jitter").
///
/// Source: M. Brooker, Exponential Backoff And Jitter, AWS Architecture Blog, 2015.
std::chrono::nanoseconds draw_pause(Backoff& backoff, std::minstd_rand& random);

/// Whether a connection was lost because its peer sent something that is no message.
inline bool is_bad(const Error& error) {
  return error.code != Code::Truncated && error.code != Code::Closed && error.code != Code::System;
}

constexpr std::chrono::milliseconds kFirstPause{100}, kLongestPause{5000};  // at most

/// Why a connection was lost, in words; what is not plainly Closed has its code.
inline std::string in_words(const Error& error) {
  return error.code == Code::Closed ? error.detail : error.text();
}

/// The longest pause between two tries at a peer on this host.
constexpr std::chrono::milliseconds kLocalPause{100};

/// Where and how to connect.
struct Peer {
  std::vector<Address> addresses;  ///< all are tried in turn
  std::string name;                ///< for error lines
  /// Whether a peer that has answered is wanted; an error says why not. May be empty.
  std::function<Status(int socket)> admit;
  /// Makes the channel of a connection, which is of use once that is agreed on. May be empty.
  std::function<std::unique_ptr<SecureChannel>(int socket)> secure = {};
  /// Between two tries; short for a peer on this host, where a try costs little.
  std::chrono::milliseconds longest_pause = kLongestPause;
};

/// Connects to a peer, and to it again when the connection is lost.
///
/// A try that is refused is followed by a pause; one without an answer within kAnswer by the next
/// try at once, since it took as long as a pause. So a network that comes back is soon in use
/// again, although the kernel's own retries are seconds apart by then. Where the network is known
/// to be down the pauses are at most kAway, for the same reason.
class Dialer {
 public:
  static constexpr std::chrono::seconds kAnswer{1}, kAway{1};
  /// A connection that lived so long was of use.
  static constexpr std::chrono::seconds kUseTime{1};

  /// How long to try for the first connection before that is logged.
  static constexpr std::chrono::seconds kQuiet{1};

  /// @param first  how long to try for the first connection before giving up,
  /// @param patience  … and for each one after that.
  Dialer(Peer peer, std::chrono::seconds first, std::chrono::seconds patience, TimePoint now);

  /// Does what is due; returns the connection, or none (-1) when there is none yet.
  ///
  /// Errors: once patience is at its end, Closed, or NotFound if there never was a connection.
  Result<ConnectedSocket> dial(TimePoint now);
  /// The current attempt; -1: none.
  [[nodiscard]] int descriptor() const { return attempt_.get(); }
  /// The poll events that it waits for.
  [[nodiscard]] short events() const { return events_; }
  /// When to dial() again at the latest.
  [[nodiscard]] TimePoint due() const;
  /// Whether all addresses have been tried and have refused, so that nobody listens now.
  [[nodiscard]] bool is_refused() const { return is_refused_; }
  /// Why the last attempt failed.
  [[nodiscard]] const std::string& why() const { return why_; }

  /// Logs to `log` when the first connection takes long, when one is lost, and the next one.
  void log_to(LogSink log) { log_ = std::move(log); }

  /// The owner uses the connection that it has got.
  void in_use();
  /// The owner has lost it. The next try is made at once, or after a pause where the connection was
  /// of no use: a peer that accepts and closes each time costs no more than a refusing one. Pauses
  /// grow where it lived for less than the first of them.
  /// @param why  for the log, and the error once patience is at its end.
  /// @param log_after  … which is not logged if a connection is in use by then.
  void lost(TimePoint now, bool was_of_use, std::string why,
            std::chrono::milliseconds log_after = {});

 private:
  void try_next(TimePoint now);
  bool is_connected(TimePoint now);
  bool has_agreed(TimePoint now);
  void fail(int number, TimePoint now);
  void log_loss();
  void log(Level level, std::string_view line) const;

  Peer peer_;
  std::chrono::seconds first_, patience_;
  bool was_there_ = false;   // a peer
  bool is_awaited_ = false;  // as has been logged
  std::minstd_rand random_{std::random_device{}()};
  Backoff backoff_;
  TimePoint begin_, give_up_, next_try_, connected_at_;
  std::size_t turn_ = 0;  // of the addresses
  bool is_refused_ = false, was_silent_ = false;
  ConnectedSocket attempt_;
  short events_ = POLLOUT;
  TimePoint answer_due_;
  std::string why_;  // the last try failed
  LogSink log_;
  std::string loss_;                      // why the last connection was lost
  TimePoint log_due_ = TimePoint::max();  // for that
  std::string news_;                      // to be logged with the next connection; empty: nothing
};

}  // namespace hc::internal
