// SPDX-License-Identifier: Apache-2.0
#pragma once
// Connections that are made again and again, by somebody who does not wait for them. Internal.

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
#include <hc/os/socket.h>

namespace hc::internal {

/// A pause between tries, so that many who lost the same peer do not come back at once: uniform
/// between 0 and what `backoff` says ("full jitter").
///
/// Source: M. Brooker, Exponential Backoff And Jitter, AWS Architecture Blog, 2015.
std::chrono::nanoseconds draw_pause(Backoff& backoff, std::minstd_rand& random);

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
  /// Between two tries: one on this host costs so little that nobody needs to be spared.
  std::chrono::milliseconds longest_pause = kLongestPause;
};

/// Connects to a peer, and to it again when the connection is lost.
///
/// A try that is refused is followed by a pause, one without an answer within kAnswer by the next
/// try at once: it was the pause. So a network that comes back is in use again soon, though the
/// kernel's own tries are seconds apart by then. Where the network is known to be away the pauses
/// are kAway at most, for the same reason.
class Dialer {
 public:
  static constexpr std::chrono::seconds kAnswer{1}, kAway{1};
  /// How long a connection lives that was of use.
  static constexpr std::chrono::seconds kUseTime{1};

  /// How long one looks for a first connection before a line says so.
  static constexpr std::chrono::seconds kQuiet{1};

  /// @param first  how long to go without a first connection before giving up,
  /// @param patience  … and without one after that.
  Dialer(Peer peer, std::chrono::seconds first, std::chrono::seconds patience, TimePoint now);

  /// Does what is to be done by now; gives the connection, or none (-1) when there is none yet.
  ///
  /// Errors: once patience is at its end, Closed, or NotFound if there never was a connection.
  Result<ConnectedSocket> dial(TimePoint now);
  /// The current attempt; -1: none.
  [[nodiscard]] int descriptor() const { return attempt_.get(); }
  /// The poll events that it waits for.
  [[nodiscard]] short events() const { return events_; }
  /// When to dial() again at the latest.
  [[nodiscard]] TimePoint due() const;
  /// Whether all addresses have been tried and have refused, so that nobody listens for now.
  [[nodiscard]] bool is_refused() const { return is_refused_; }
  /// Why the last attempt failed.
  [[nodiscard]] const std::string& why() const { return why_; }

  /// A line for the log when the first connection is long in coming; once.
  std::optional<std::string> take_remark(TimePoint now);

  /// Says that the connection has been lost: then the next try is made at once, but after a pause
  /// if it was of no use (`why`, in words, for the error once patience is at its end), so that one
  /// which is made and lost each time costs no more than others.
  void lost(TimePoint now, bool was_of_use, std::string why);

 private:
  void try_next(TimePoint now);
  bool is_connected(TimePoint now);
  bool has_agreed(TimePoint now);
  void fail(int number, TimePoint now);

  Peer peer_;
  std::chrono::seconds first_, patience_;
  bool was_there_ = false;  // a peer
  bool told_ = false;
  std::minstd_rand random_{std::random_device{}()};
  Backoff backoff_;
  TimePoint begin_, give_up_, next_try_;
  std::size_t turn_ = 0;  // of the addresses
  bool is_refused_ = false, was_silent_ = false;
  ConnectedSocket attempt_;
  short events_ = POLLOUT;
  TimePoint answer_due_;
  std::string why_;  // the last try failed
};

}  // namespace hc::internal
