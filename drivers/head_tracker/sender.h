// SPDX-License-Identifier: Apache-2.0
#pragma once
// Sends poses of a head as opentrack does, to whoever listens at an address.

#include <string>

#include <drivers/head_tracker/pose.h>
#include <hc/base/result.h>

namespace hc {

/// For one thread.
class HeadPoseSender {
 public:
  /// @param address  "127.0.0.1:4242", of IPv4.
  ///
  /// Errors: Invalid (no address, or no port), System.
  static Result<HeadPoseSender> open(const std::string& address);
  HeadPoseSender(HeadPoseSender&& other) noexcept;
  HeadPoseSender& operator=(HeadPoseSender&&) = delete;
  ~HeadPoseSender();

  /// Sends a packet. A packet that nobody receives is lost, as on any network.
  ///
  /// Errors: System.
  Result<void> send(const HeadPose& pose);

 private:
  explicit HeadPoseSender(int socket) : socket_(socket) {}

  int socket_ = -1;
};

}  // namespace hc
