// SPDX-License-Identifier: Apache-2.0
#pragma once
// What may stand between a connected socket and the bytes that it carries: encryption.

#include <sys/types.h>
#include <sys/uio.h>

#include <cstddef>
#include <memory>
#include <span>

#include <hc/base/result.h>
#include <hc/os/descriptor.h>

namespace hc {

/// Reads and writes the bytes of a connection in place of recv() and sendmsg(); never waits.
class SecureChannel {
 public:
  virtual ~SecureChannel() = default;

  /// Continues the handshake; the poll events that it waits for, 0: it is done.
  ///
  /// Errors: Closed (one side refused the other; the detail says which, and why).
  virtual Result<short> agree() = 0;

  /// As recv() and sendmsg(); where they give -1 with another errno than EAGAIN, failure() says
  /// why.
  virtual ssize_t read(std::span<std::byte> space) = 0;
  virtual ssize_t write(std::span<const iovec> parts) = 0;
  [[nodiscard]] virtual Error failure() const = 0;

  /// Whether bytes have been taken from the socket that read() has not given yet.
  [[nodiscard]] virtual bool has_unread() const = 0;
  /// Whether bytes that write() took are not with the kernel yet; write() continues, also with no
  /// parts.
  [[nodiscard]] virtual bool has_unsent() const = 0;
  /// Says that nothing more will be written.
  virtual void end() = 0;
};

/// A socket that is connected, with its channel if it has one.
struct ConnectedSocket {
  Descriptor descriptor;
  std::unique_ptr<SecureChannel> channel = nullptr;

  [[nodiscard]] int get() const { return descriptor.get(); }
  explicit operator bool() const { return static_cast<bool>(descriptor); }
};

}  // namespace hc
