// SPDX-License-Identifier: Apache-2.0
#pragma once
// A TLS-encrypted connection. Internal. Used by one thread at a time.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <openssl/ssl.h>

#include <hc/os/secure_channel.h>
#include <tls/context.h>

namespace hc::tls {

/// TLS over a socket. A client's handshake completes only when the server has accepted its key, so
/// that a refused client learns of it before it sends anything. The server sends the acceptance
/// with its next write(), which may be empty.
class TlsChannel final : public SecureChannel {
 public:
  enum class Side { Dials, Listens };

  /// @param socket  non-blocking, stays open as long as the channel.
  TlsChannel(std::shared_ptr<const Context> context, int socket, Side side);
  ~TlsChannel() override;
  TlsChannel(const TlsChannel&) = delete;
  TlsChannel& operator=(const TlsChannel&) = delete;

  Result<short> agree() override;
  ssize_t read(std::span<std::byte> space) override;
  ssize_t write(std::span<const iovec> parts) override;
  [[nodiscard]] Error failure() const override { return failure_.value_or(Error()); }
  [[nodiscard]] bool has_unread() const override;
  [[nodiscard]] bool has_unsent() const override { return sent_ < unsent_.size(); }
  void end() override;

  // Callbacks from OpenSSL.
  static TlsChannel& of(const SSL* ssl);
  void refuse(std::string fingerprint) { refused_key_ = std::move(fingerprint); }
  void confirm() { is_confirmed_ = true; }
  /// Sends or queues encrypted bytes; -1: no room, or errno has the reason.
  int send(std::span<const char> bytes);

 private:
  enum class State { Handshaking, AwaitingTicket, Open, Failed };

  Result<short> awaited(int result);
  bool flush();
  void fail(int result);
  [[nodiscard]] std::string why_refused(int result) const;
  std::span<const std::byte> next_record(std::span<const iovec> parts, std::size_t skip);

  std::shared_ptr<const Context> context_;
  int socket_;
  Side side_;
  State state_ = State::Handshaking;
  std::unique_ptr<SSL, Free<SSL_free>> ssl_;
  std::optional<std::string> refused_key_;  // fingerprint of the peer's key
  bool is_confirmed_ = false, has_ended_ = false;
  std::optional<Error> failure_;
  int send_errno_ = 0;
  std::vector<char> unsent_;  // encrypted bytes, pending from sent_ on
  std::size_t sent_ = 0;
  std::vector<std::byte> record_;  // gathered from several parts
  std::uint64_t records_ = 0;      // number of records written
};

}  // namespace hc::tls
