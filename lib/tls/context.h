// SPDX-License-Identifier: Apache-2.0
#pragma once
// Who one end of a TLS link is, and whom it lets in: what all its connections share. Internal.

#include <memory>
#include <set>
#include <string>

#include <openssl/ssl.h>

#include <hc/base/result.h>
#include <hc/base/uri.h>

namespace hc::tls {

/// Deletes what OpenSSL has made.
template <auto free>
struct Free {
  template <typename Object>
  void operator()(Object* object) const {
    free(object);
  }
};
using Certificate = std::unique_ptr<X509, Free<X509_free>>;
using File = std::unique_ptr<BIO, Free<BIO_free>>;

/// "hc key eyes.pem: no start line", from what OpenSSL last complained of.
Error openssl_error(Code code, const std::string& what);

/// The fingerprint of a certificate's key; see fingerprint_of().
std::string fingerprint(const X509& certificate);

/// Opens a file to be read. Errors: NotFound, System.
Result<File> open_file(const std::string& path);

/// Whether a URI has the options `key` and `peer`. Errors: Invalid.
Status check_keys(const Uri& uri);

/// An end's own key, and the fingerprints of the keys that it accepts.
class Context {
 public:
  /// By the options `key=FILE` and `peer=FINGERPRINT` or `peer=FILE` of certificates.
  ///
  /// Errors: Invalid (an option is missing; a file has no key or certificate; others may read the
  /// key), NotFound, System.
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
