// SPDX-License-Identifier: Apache-2.0
#include <hc/link/stream/ends.h>
#include <tls/key.h>

extern "C" {
extern const int kHcTlsTransport;
const int kHcTlsTransport = 0;
}

namespace hc {
namespace {

Error no_openssl() {
  return {Code::Unsupported,
          "tls: links need OpenSSL, which this program was built without; install libssl-dev and "
          "build it again"};
}

}  // namespace

namespace internal {

Result<Peer> tls_peer(const Uri&) {
  return no_openssl();
}
Result<ListeningSocket> listen_tls(const Uri&) {
  return no_openssl();
}

}  // namespace internal

namespace tls {

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

}  // namespace tls
}  // namespace hc
