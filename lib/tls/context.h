// SPDX-License-Identifier: Apache-2.0
#pragma once
// The identity of one end of a TLS link and the keys it accepts, for all its connections. Internal.

#include <memory>
#include <set>
#include <string>

#include <openssl/ssl.h>

#include <hc/base/result.h>
#include <hc/base/uri.h>

namespace hc::tls {

template <auto free>
struct Free {
  template <typename Object>
  void operator()(Object* object) const {
    free(object);
  }
};
using Certificate = std::unique_ptr<X509, Free<X509_free>>;
using File = std::unique_ptr<BIO, Free<BIO_free>>;

/// "hc key eyes.pem: no start line", from OpenSSL's last error.
Error openssl_error(Code code, const std::string& what);

/// The fingerprint of a certificate's key; see fingerprint_of().
std::string fingerprint(const X509& certificate);

/// Opens a file for reading. Errors: NotFound, System.
Result<File> open_file(const std::string& path);

/// Checks that a URI has the options `key` and `peer`. Errors: Invalid.
Status check_keys(const Uri& uri);

/// The key of an end, and the fingerprints of the keys that it accepts.
class Context {
 public:
  /// From the options `key=FILE`, and `peer=FINGERPRINT` or `peer=FILE` with certificates.
  ///
  /// Errors: Invalid (an option is missing; a file has no key or certificate; the key is readable
  /// by other users), NotFound, System.
  static Result<std::shared_ptr<const Context>> make(const Uri& uri);

  [[nodiscard]] SSL_CTX* get() const { return context_.get(); }
  [[nodiscard]] bool accepts(const std::string& fingerprint) const {
    return peers_.contains(fingerprint);
  }

 private:
  Context() = default;
  Status set_up();
  Status use_key(const std::string& path);
  Status add_peers(const std::string& peer);

  std::unique_ptr<SSL_CTX, Free<SSL_CTX_free>> context_;
  std::set<std::string> peers_;
};

}  // namespace hc::tls
