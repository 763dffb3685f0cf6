// SPDX-License-Identifier: Apache-2.0
#include <tls/key.h>

#include <unistd.h>

#include <openssl/err.h>
#include <openssl/evp.h>
#include <openssl/pem.h>
#include <openssl/x509v3.h>

#include <hc/os/new_file.h>
#include <tls/context.h>

namespace hc::tls {
namespace {

using Key = std::unique_ptr<EVP_PKEY, Free<EVP_PKEY_free>>;

/// A self-signed certificate of a key, as TLS requires one.
Certificate certificate_for(EVP_PKEY& key) {
  Certificate certificate(X509_new());
  constexpr long kVersion3 = 2;
  const std::unique_ptr<X509_EXTENSION, Free<X509_EXTENSION_free>> hosts(
      X509V3_EXT_conf_nid(nullptr, nullptr, NID_subject_alt_name, "DNS:localhost,IP:127.0.0.1"));
  auto* name = certificate ? X509_get_subject_name(certificate.get()) : nullptr;
  if (name == nullptr || X509_set_version(certificate.get(), kVersion3) != 1 ||
      ASN1_INTEGER_set(X509_get_serialNumber(certificate.get()), 1) != 1 ||
      ASN1_TIME_set_string(X509_getm_notBefore(certificate.get()), "20000101000000Z") != 1 ||
      ASN1_TIME_set_string(X509_getm_notAfter(certificate.get()), "99991231235959Z") != 1 ||
      X509_set_pubkey(certificate.get(), &key) != 1 ||
      X509_NAME_add_entry_by_txt(name, "CN", MBSTRING_ASC,
                                 reinterpret_cast<const unsigned char*>("hypercolumn"), -1, -1,
                                 0) != 1 ||
      X509_set_issuer_name(certificate.get(), name) != 1 || !hosts ||
      X509_add_ext(certificate.get(), hosts.get(), -1) != 1 ||
      X509_sign(certificate.get(), &key, EVP_sha256()) == 0)
    return nullptr;
  return certificate;
}

}  // namespace

Result<std::string> make_key_text() {
  ERR_clear_error();
  const Key key(EVP_EC_gen("P-256"));
  const auto certificate = key ? certificate_for(*key) : nullptr;
  const File pem(BIO_new(BIO_s_mem()));
  if (!certificate || !pem ||
      PEM_write_bio_PrivateKey(pem.get(), key.get(), nullptr, nullptr, 0, nullptr, nullptr) != 1 ||
      PEM_write_bio_X509(pem.get(), certificate.get()) != 1)
    return openssl_error(Code::System, "cannot create a key");
  char* text = nullptr;
  const auto size = BIO_get_mem_data(pem.get(), &text);
  return std::string(text, static_cast<std::size_t>(size));
}

Status make_key(const std::string& path) {
  if (::access(path.c_str(), F_OK) == 0) return {};
  return make_private_file(path, HC_TRY(make_key_text()));
}

Result<std::string> fingerprint_of(const std::string& path) {
  auto file = HC_TRY(open_file(path));
  const Certificate certificate(PEM_read_bio_X509(file.get(), nullptr, nullptr, nullptr));
  if (!certificate) return Error{Code::Invalid, path + ": no certificate in PEM"};
  return fingerprint(*certificate);
}

Result<std::string> fingerprint_of_text(const std::string& pem) {
  const File text(BIO_new_mem_buf(pem.data(), static_cast<int>(pem.size())));
  const Certificate certificate(PEM_read_bio_X509(text.get(), nullptr, nullptr, nullptr));
  if (!certificate) return Error{Code::Invalid, "no certificate in PEM"};
  return fingerprint(*certificate);
}

}  // namespace hc::tls
