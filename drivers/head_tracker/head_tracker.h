// SPDX-License-Identifier: Apache-2.0
#pragma once
// A head tracker that speaks opentrack's UDP, heard at a port; and whether it is there.

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include <drivers/head_tracker/pose.h>
#include <hc/base/clock.h>
#include <hc/base/result.h>

namespace hc {

/// A pose, and when its packet came.
struct TimedHeadPose {
  HeadPose pose;
  std::int64_t time = 0;  ///< of the packet's arrival [ns since the Unix epoch]
};

/// Hears packets. For one thread.
class HeadTracker {
 public:
  /// @param host  an address of this machine: "127.0.0.1", "0.0.0.0" for all, "::1".
  /// @param port  0 takes a free one.
  ///
  /// Errors: Invalid (no address), System (the port is in use, …).
  static Result<HeadTracker> open(const std::string& host, int port);
  HeadTracker(HeadTracker&& other) noexcept;
  HeadTracker& operator=(HeadTracker&&) = delete;
  ~HeadTracker();

  /// Waits for packets, and gives the newest of those that came: old ones are of no use to who
  /// follows a head. Nothing when `timeout` has passed, `stop` is readable, or nothing was right.
  ///
  /// Errors: System.
  Result<std::optional<TimedHeadPose>> receive(std::chrono::milliseconds timeout, int stop = -1);

  [[nodiscard]] int port() const { return port_; }
  /// Packets that were no pose, and why the last was none.
  [[nodiscard]] std::uint64_t ignored() const { return ignored_; }
  [[nodiscard]] const std::string& why_ignored() const { return why_ignored_; }

 private:
  HeadTracker(int socket, int port) : socket_(socket), port_(port) {}

  int socket_ = -1;
  int port_ = 0;
  std::uint64_t ignored_ = 0;
  std::string why_ignored_;
};

/// Whether something is heard from again and again; tells the changes once each. Pure.
class Presence {
 public:
  enum class Change { None, Came, Silent };
  /// @param now  when it begins to be waited for.
  explicit Presence(MonotonicTime now) : last_(now) {}

  /// @param heard  whether it was heard since the last look.
  /// @param silence  how long nothing may be heard.
  Change look(MonotonicTime now, bool heard, std::chrono::nanoseconds silence);

 private:
  MonotonicTime last_;
  enum class State { Waiting, There, Gone } state_ = State::Waiting;
};

}  // namespace hc
