// SPDX-License-Identifier: Apache-2.0
#pragma once
// The bytes of one connection, encrypted by TLS. Internal; from one thread at a time.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <openssl/ssl.h>

#include <hc/os/secure_channel.h>
#include <tls/context.h>

namespace hc::tls {

/// TLS over a socket. A client has agreed once the server has said that it accepts the client's
/// key, so that one that is refused hears of it before it sends anything; the server says it by its
/// next write(), of nothing at least.
class TlsChannel final : public SecureChannel {
 public:
  enum class Side { Dials, Listens };

  /// @param socket  stays open as long as this; its calls do not wait.
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

  // OpenSSL calls.
  static TlsChannel& of(const SSL* ssl);
  void refuse(std::string fingerprint) { refused_ = std::move(fingerprint); }
  void confirm() { is_confirmed_ = true; }
  /// Sends encrypted bytes, or keeps them; -1: there is no room, or errno says why not.
  int send(std::span<const char> bytes);

 private:
  enum class State { Greets, AwaitsAnswer, Agreed, Failed };

  Result<short> awaited(int result);
  bool flush();
  void fail(int result);
  [[nodiscard]] std::string why_refused(int result) const;
  std::span<const std::byte> next_record(std::span<const iovec> parts, std::size_t skip);

  std::shared_ptr<const Context> context_;
  int socket_;
  Side side_;
  State state_ = State::Greets;
  std::unique_ptr<SSL, Free<SSL_free>> ssl_;
  std::optional<std::string> refused_;  // the key that the peer has shown
  bool is_confirmed_ = false, has_ended_ = false;
  std::optional<Error> failure_;
  int send_errno_ = 0;
  std::vector<char> unsent_;  // encrypted, from sent_ on
  std::size_t sent_ = 0;
  std::vector<std::byte> record_;  // what is gathered of several parts
  std::uint64_t records_ = 0;      // written with the key there is
};

}  // namespace hc::tls
