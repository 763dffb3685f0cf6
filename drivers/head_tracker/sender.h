// SPDX-License-Identifier: Apache-2.0
#pragma once
// Sends poses of a head as opentrack packets to an address.

#include <string>
#include <utility>

#include <drivers/head_tracker/pose.h>
#include <hc/base/result.h>
#include <hc/os/descriptor.h>

namespace hc {

/// For one thread.
class HeadPoseSender {
 public:
  /// @param address  IPv4, "127.0.0.1:4242".
  ///
  /// Errors: Invalid (not an address and port), System.
  static Result<HeadPoseSender> open(const std::string& address);

  /// Sends a packet; lost without a receiver. Errors: System.
  Result<void> send(const HeadPose& pose);

 private:
  explicit HeadPoseSender(Descriptor socket) : socket_(std::move(socket)) {}

  Descriptor socket_;
};

}  // namespace hc
