// SPDX-License-Identifier: Apache-2.0
#pragma once
// For tests: a peer of a TLS link, implemented with OpenSSL only, and keys.

#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>
#include <utility>

#include <openssl/err.h>
#include <openssl/ssl.h>

#include <hc/base/uri.h>
#include <hc/os/descriptor.h>
#include <hc/testing/files.h>
#include <hc/testing/link_conformance.h>
#include <hc/testing/loopback.h>
#include <tls/context.h>
#include <tls/key.h>
#include <tls/transport.h>

namespace hc::testing {

inline const bool kHasTls = [] {
  tls::add_transports();
  return true;
}();

/// The path of a key in a folder of this process, created on first use.
inline std::string key_file(const std::string& name) {
  static const Folder kKeys;
  std::string path = kKeys / (name + ".pem");
  if (!std::filesystem::exists(path)) {
    EXPECT_TRUE(tls::make_key(path));
  }
  return path;
}

/// Options of an end with one key that accepts the other.
inline std::string options(const std::string& own, const std::string& peer) {
  return "?key=" + key_file(own) + "&peer=" + *tls::fingerprint_of(key_file(peer));
}

using Context = std::unique_ptr<SSL_CTX, tls::Free<SSL_CTX_free>>;
using Session = std::unique_ptr<SSL, tls::Free<SSL_free>>;

/// An OpenSSL context with a key, or without one (empty), that accepts any peer.
inline Context make_context(const std::string& key) {
  Context context(SSL_CTX_new(TLS_method()));
  SSL_CTX_set_verify(context.get(), SSL_VERIFY_PEER, nullptr);
  SSL_CTX_set_cert_verify_callback(
      context.get(), [](X509_STORE_CTX*, void*) { return 1; }, nullptr);
  SSL_CTX_clear_mode(context.get(), SSL_MODE_AUTO_RETRY);
  SSL_CTX_set_session_id_context(context.get(), reinterpret_cast<const unsigned char*>("t"), 1);
  if (key.empty()) return context;
  const auto path = key_file(key);
  EXPECT_EQ(SSL_CTX_use_certificate_file(context.get(), path.c_str(), SSL_FILETYPE_PEM), 1);
  EXPECT_EQ(SSL_CTX_use_PrivateKey_file(context.get(), path.c_str(), SSL_FILETYPE_PEM), 1);
  return context;
}

/// A TCP socket connected to a place.
inline Descriptor connect_plainly(const std::string& place) {
  Descriptor socket(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
  sockaddr_in address = loopback(parse_host_port(place)->port);
  EXPECT_EQ(::connect(socket.get(), reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
  return socket;
}

/// OpenSSL's last error.
inline std::string complaint() {
  const char* text = ERR_reason_error_string(ERR_peek_last_error());
  return text == nullptr ? "" : text;
}

/// Relays bytes between a plain socket and TLS on a thread, until one of them has ended.
inline void relay(Session session, Descriptor secure, Descriptor plain) {
  std::thread([session = std::move(session), secure = std::move(secure), plain = std::move(plain)] {
    std::array<char, 1 << 14> bytes{};
    std::array<pollfd, 2> polled = {{{plain.get(), POLLIN, 0}, {secure.get(), POLLIN, 0}}};
    auto* ssl = session.get();
    while (true) {
      if (SSL_has_pending(ssl) == 0) ::poll(polled.data(), polled.size(), -1);
      if (polled[0].revents != 0) {
        const auto size = ::recv(plain.get(), bytes.data(), bytes.size(), MSG_DONTWAIT);
        if (size > 0 && SSL_write(ssl, bytes.data(), static_cast<int>(size)) <= 0) break;
        if (size == 0) {
          SSL_shutdown(ssl);
          ::shutdown(secure.get(), SHUT_WR);
          if ((polled[0].revents & POLLHUP) != 0) break;
          polled[0].fd = -1;  // only reads from now on
          polled[0].revents = 0;
        }
      }
      if (polled[1].revents == 0 && SSL_has_pending(ssl) == 0) continue;
      const int size = SSL_read(ssl, bytes.data(), static_cast<int>(bytes.size()));
      if (size <= 0 && SSL_get_error(ssl, size) == SSL_ERROR_WANT_READ) continue;
      if (size <= 0) break;
      if (::send(plain.get(), bytes.data(), static_cast<std::size_t>(size), MSG_NOSIGNAL) != size)
        break;
    }
  }).detach();
}

/// A pair of connected sockets.
inline std::pair<Descriptor, Descriptor> make_pair() {
  std::array<int, 2> ends{};
  EXPECT_EQ(::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()), 0);
  return {Descriptor(ends[0]), Descriptor(ends[1])};
}

/// Performs a handshake as a client over a blocking socket; null if it fails.
inline Session shake_hands(SSL_CTX* context, const Descriptor& socket) {
  ERR_clear_error();
  Session session(SSL_new(context));
  SSL_set_fd(session.get(), socket.get());
  if (SSL_connect(session.get()) != 1) return nullptr;
  char byte = 0;
  const int size = SSL_peek(session.get(), &byte, 1);  // receives the ticket or the refusal
  if (size <= 0 && SSL_get_error(session.get(), size) != SSL_ERROR_WANT_READ) return nullptr;
  return session;
}

}  // namespace hc::testing
