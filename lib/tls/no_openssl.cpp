// SPDX-License-Identifier: Apache-2.0
// Compiled instead of the other files if OpenSSL was not found.
#include <tls/key.h>
#include <tls/transport.h>

namespace hc::tls {
namespace {

Error no_openssl() {
  return {Code::Unsupported,
          "keys need OpenSSL, which this program was built without; install libssl-dev and rebuild "
          "it"};
}

}  // namespace

void add_transports() {}

Result<std::string> make_key_text() {
  return no_openssl();
}
Result<std::string> fingerprint_of_text(const std::string&) {
  return no_openssl();
}
Status make_key(const std::string&) {
  return no_openssl();
}
Result<std::string> fingerprint_of(const std::string&) {
  return no_openssl();
}

}  // namespace hc::tls
