// SPDX-License-Identifier: Apache-2.0
#include <tls/context.h>

#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <memory>
#include <span>
#include <vector>

#include <openssl/err.h>
#include <openssl/pem.h>
#include <openssl/x509.h>

#include <hc/base/format.h>
#include <hc/os/descriptor.h>
#include <tls/channel.h>

namespace hc::tls {
namespace {

constexpr std::size_t kFingerprintDigits = 64;
/// Read-ahead; a TLS record has at most 16 KiB.
constexpr std::size_t kReadBytes = 64 << 10;

bool is_fingerprint(const std::string& text) {
  return text.size() == kFingerprintDigits &&
         text.find_first_not_of("0123456789abcdef") == std::string::npos;
}

/// Accepts known keys in place of a chain of signatures. The handshake proves that the peer has the
/// private key.
int verify(X509_STORE_CTX* store, void* context) {
  const auto* certificate = X509_STORE_CTX_get0_cert(store);
  const auto* ssl = static_cast<const SSL*>(
      X509_STORE_CTX_get_ex_data(store, SSL_get_ex_data_X509_STORE_CTX_idx()));
  auto key = certificate != nullptr ? fingerprint(*certificate) : "";
  if (static_cast<const Context*>(context)->accepts(key)) return 1;
  TlsChannel::of(ssl).refuse(std::move(key));
  X509_STORE_CTX_set_error(store, X509_V_ERR_CERT_REJECTED);
  return 0;
}

int note_ticket(SSL* ssl, SSL_SESSION*) {
  TlsChannel::of(ssl).confirm();
  return 0;
}

int make_ticket(SSL*, void*) {
  return 1;
}

/// Sessions are not resumed; each connection has a complete handshake.
SSL_TICKET_RETURN ignore_ticket(SSL*, SSL_SESSION*, const unsigned char*, size_t, SSL_TICKET_STATUS,
                                void*) {
  return SSL_TICKET_RETURN_IGNORE;
}

}  // namespace

Error openssl_error(Code code, const std::string& what) {
  const char* reason = ERR_reason_error_string(ERR_peek_last_error());
  return {code, what + ": " + (reason != nullptr ? reason : "OpenSSL failed")};
}

std::string fingerprint(const X509& certificate) {
  unsigned char* der = nullptr;
  const int size = i2d_X509_PUBKEY(X509_get_X509_PUBKEY(&certificate), &der);
  if (size <= 0) return "";
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned length = 0;
  EVP_Digest(der, static_cast<std::size_t>(size), digest.data(), &length, EVP_sha256(), nullptr);
  OPENSSL_free(der);
  return hexadecimal(std::span(digest).first(length));
}

Result<File> open_file(const std::string& path) {
  File file(BIO_new_file(path.c_str(), "r"));
  if (!file) return system_error("open", path);
  return file;
}

Status check_keys(const Uri& uri) {
  if (!uri.option("key", "").empty() && !uri.option("peer", "").empty()) return {};
  return Error{
      Code::Invalid,
      uri.scheme + " needs the options key=FILE and peer=FINGERPRINT; hc key FILE makes a key"};
}

Result<std::shared_ptr<const Context>> Context::make(const Uri& uri) {
  HC_TRY(check_keys(uri));
  std::shared_ptr<Context> made(new Context);
  HC_TRY(made->set_up());
  HC_TRY(made->use_key(std::string(uri.option("key", ""))));
  HC_TRY(made->add_peers(std::string(uri.option("peer", ""))));
  return std::shared_ptr<const Context>(made);
}

Status Context::set_up() {
  context_.reset(SSL_CTX_new(TLS_method()));
  auto* context = context_.get();
  if (context == nullptr || SSL_CTX_set_min_proto_version(context, TLS1_3_VERSION) != 1 ||
      SSL_CTX_set1_groups_list(context, "X25519:P-256") != 1)
    return openssl_error(Code::System, "OpenSSL");
  SSL_CTX_set_mode(context, SSL_MODE_RELEASE_BUFFERS);
  SSL_CTX_set_default_read_buffer_len(context, kReadBytes);
  SSL_CTX_set_verify(context, SSL_VERIFY_PEER | SSL_VERIFY_FAIL_IF_NO_PEER_CERT, nullptr);
  SSL_CTX_set_cert_verify_callback(context, verify, this);
  // The session ticket is the last handshake record of a server, sent once it has accepted a
  // client.
  SSL_CTX_set_session_cache_mode(context, SSL_SESS_CACHE_CLIENT | SSL_SESS_CACHE_NO_INTERNAL);
  SSL_CTX_sess_set_new_cb(context, note_ticket);
  SSL_CTX_set_num_tickets(context, 1);
  SSL_CTX_set_session_ticket_cb(context, make_ticket, ignore_ticket, nullptr);
  return {};
}

Status Context::use_key(const std::string& path) {
  struct stat status {};
  auto looked = system_call("open", path, [&] { return ::stat(path.c_str(), &status); });
  if (!looked) return looked.error();
  if ((status.st_mode & (S_IRWXG | S_IRWXO)) != 0)
    return Error{Code::Invalid,
                 "key " + path + ": other users may read it; chmod 600 it, or make a new one"};
  ERR_clear_error();
  if (SSL_CTX_use_certificate_file(get(), path.c_str(), SSL_FILETYPE_PEM) != 1 ||
      SSL_CTX_use_PrivateKey_file(get(), path.c_str(), SSL_FILETYPE_PEM) != 1 ||
      SSL_CTX_check_private_key(get()) != 1)
    return openssl_error(Code::Invalid, "key " + path +
                                            ": no key and certificate in PEM (remove it, and "
                                            "hc key " +
                                            path + " creates a new one)");
  return {};
}

Status Context::add_peers(const std::string& peer) {
  if (is_fingerprint(peer)) {
    peers_.insert(peer);
    return {};
  }
  auto file = open_file(peer);
  if (!file && file.error().code == Code::NotFound)
    return Error{Code::Invalid, "peer " + peer + ": neither a file nor a fingerprint, which has " +
                                    std::to_string(kFingerprintDigits) + " hexadecimal digits"};
  if (!file) return file.error();
  while (true) {
    Certificate certificate(PEM_read_bio_X509(file->get(), nullptr, nullptr, nullptr));
    if (!certificate) break;
    peers_.insert(fingerprint(*certificate));
  }
  if (peers_.empty()) return Error{Code::Invalid, "peer " + peer + ": no certificate in PEM"};
  return {};
}

}  // namespace hc::tls
