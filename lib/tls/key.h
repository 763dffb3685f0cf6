// SPDX-License-Identifier: Apache-2.0
#pragma once
// Keys that identify the ends of a TLS link: P-256, in a file with a self-signed certificate, which
// is valid from 2000 to 9999 and has the names of this host, checked only by browsers.

#include <string>

#include <hc/base/result.h>

namespace hc::tls {

/// A new key and its certificate, in PEM. Errors: System, Unsupported (built without OpenSSL).
Result<std::string> make_key_text();

/// Writes a new key and its certificate, in PEM, to a file that only its owner can read, unless it
/// exists. Concurrent calls leave one complete key, which all find.
///
/// Errors: System (the file cannot be written), NotFound (no such folder), Unsupported (built
/// without OpenSSL).
Status make_key(const std::string& path);

/// The fingerprint of a key: SHA-256 of its public half (SubjectPublicKeyInfo, DER), in 64
/// hexadecimal digits. If the file has several certificates, of the first.
///
/// Errors: NotFound, Invalid (no certificate in PEM), System, Unsupported (built without OpenSSL).
Result<std::string> fingerprint_of(const std::string& path);
/// The fingerprint of the first certificate in a text.
Result<std::string> fingerprint_of_text(const std::string& pem);

}  // namespace hc::tls
