// SPDX-License-Identifier: Apache-2.0
#pragma once
// Keys by which the two ends of a TLS link know each other: P-256, in a file with a certificate
// that is self-signed, valid from 2000 to 9999, and has the names of this host, which only browsers
// check.

#include <string>

#include <hc/base/result.h>

namespace hc::tls {

/// A new key and its certificate, in PEM. Errors: System, Unsupported (built without OpenSSL).
Result<std::string> make_key_text();

/// Writes a new key and its certificate, in PEM, to a file that only its owner can read, unless it
/// is there. Of several that do so at once all find the same key, and never a part of it.
///
/// Errors: System (it cannot be written), NotFound (no such folder), Unsupported (built without
/// OpenSSL).
Status make_key(const std::string& path);

/// The fingerprint of a key: SHA-256 of its public half (SubjectPublicKeyInfo, DER), in 64 digits
/// of base 16. Of a file with several certificates, that of the first.
///
/// Errors: NotFound, Invalid (no certificate in PEM), System, Unsupported (built without OpenSSL).
Result<std::string> fingerprint_of(const std::string& path);
/// The same of a text.
Result<std::string> fingerprint_of_text(const std::string& pem);

}  // namespace hc::tls
