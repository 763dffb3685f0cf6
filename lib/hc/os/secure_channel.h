// SPDX-License-Identifier: Apache-2.0
#pragma once
// Encryption between a connected socket and its user.

#include <sys/types.h>
#include <sys/uio.h>

#include <cstddef>
#include <memory>
#include <span>

#include <hc/base/result.h>
#include <hc/os/descriptor.h>

namespace hc {

/// Reads and writes a connection in place of recv() and sendmsg(); never blocks.
class SecureChannel {
 public:
  virtual ~SecureChannel() = default;

  /// Continues the handshake; returns the poll events to wait for, 0 when it is complete.
  ///
  /// Errors: Closed (one side refused the other; the detail says which one and why).
  virtual Result<short> agree() = 0;

  /// As recv() and sendmsg(); if they return -1 with another errno than EAGAIN, failure() has the
  /// reason.
  virtual ssize_t read(std::span<std::byte> space) = 0;
  virtual ssize_t write(std::span<const iovec> parts) = 0;
  [[nodiscard]] virtual Error failure() const = 0;

  /// Whether bytes have been received that read() has not returned yet.
  [[nodiscard]] virtual bool has_unread() const = 0;
  /// Whether bytes accepted by write() have not reached the kernel yet; call write() again, if
  /// necessary without parts.
  [[nodiscard]] virtual bool has_unsent() const = 0;
  /// Closes the sending direction.
  virtual void end() = 0;
};

/// A connected socket, with its channel if it is encrypted.
struct ConnectedSocket {
  Descriptor descriptor;
  std::unique_ptr<SecureChannel> channel = nullptr;

  [[nodiscard]] int get() const { return descriptor.get(); }
  explicit operator bool() const { return static_cast<bool>(descriptor); }
};

}  // namespace hc
