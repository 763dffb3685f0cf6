// SPDX-License-Identifier: Apache-2.0
#pragma once
// A head tracker that sends opentrack's UDP packets to a port.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include <drivers/head_tracker/pose.h>
#include <hc/base/result.h>

namespace hc {

/// A pose, and when its packet came.
struct TimedHeadPose {
  HeadPose pose;
  std::int64_t time = 0;  ///< of the packet's arrival [ns since the Unix epoch]
};

/// Receives packets. For one thread.
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

  /// The newest pose that has come; older ones are of no use for following a head. Nothing when no
  /// valid packet has come. Never waits.
  ///
  /// Errors: System.
  Result<std::optional<TimedHeadPose>> receive();

  /// For poll().
  [[nodiscard]] int descriptor() const { return socket_; }
  [[nodiscard]] int port() const { return port_; }
  /// Invalid packets so far, and why the last one was.
  [[nodiscard]] std::uint64_t ignored() const { return ignored_; }
  [[nodiscard]] const std::string& why_ignored() const { return why_ignored_; }

 private:
  HeadTracker(int socket, int port) : socket_(socket), port_(port) {}

  int socket_ = -1;
  int port_ = 0;
  std::uint64_t ignored_ = 0;
  std::string why_ignored_;
};

}  // namespace hc
