// SPDX-License-Identifier: Apache-2.0
#include <web/identity.h>

#include <fcntl.h>
#include <openssl/evp.h>
#include <openssl/pem.h>
#include <openssl/x509v3.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>

#include <hc/os/program.h>

namespace hc::web {

namespace {

template <auto kFree>
struct Free {
  template <typename T>
  void operator()(T* object) const {
    kFree(object);
  }
};
using Key = std::unique_ptr<EVP_PKEY, Free<EVP_PKEY_free>>;
using Certificate = std::unique_ptr<X509, Free<X509_free>>;
using Bio = std::unique_ptr<BIO, Free<BIO_free_all>>;

Error failed(const std::string& what) {
  return {Code::System, "certificate: cannot " + what};
}

std::string text_of(BIO* bio) {
  char* data = nullptr;
  const long size = BIO_get_mem_data(bio, &data);
  return {data, static_cast<std::size_t>(size)};
}

std::string read_file(const std::string& path) {
  std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

Status write_secret(const std::string& path, const std::string& text) {
  const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  if (file < 0) return failed("write " + path);
  auto written = write_all(file, text);
  ::close(file);
  return written;
}

Certificate read_certificate(const std::string& text) {
  const Bio bio(BIO_new_mem_buf(text.data(), static_cast<int>(text.size())));
  return Certificate(PEM_read_bio_X509(bio.get(), nullptr, nullptr, nullptr));
}

Result<Identity> make_identity() {
  const Key key(EVP_EC_gen("P-256"));
  const Certificate certificate(X509_new());
  if (!key || !certificate) return failed("make a key");
  constexpr long kSeconds = 20L * 365 * 86400;
  X509_set_version(certificate.get(), X509_VERSION_3);
  ASN1_INTEGER_set_int64(X509_get_serialNumber(certificate.get()), 1);
  X509_gmtime_adj(X509_getm_notBefore(certificate.get()), -86400);
  X509_gmtime_adj(X509_getm_notAfter(certificate.get()), kSeconds);
  X509_set_pubkey(certificate.get(), key.get());
  X509_NAME* name = X509_get_subject_name(certificate.get());
  X509_NAME_add_entry_by_txt(name, "CN", MBSTRING_ASC,
                             reinterpret_cast<const unsigned char*>("hypercolumn"), -1, -1, 0);
  X509_set_issuer_name(certificate.get(), name);
  X509_EXTENSION* names =
      X509V3_EXT_conf_nid(nullptr, nullptr, NID_subject_alt_name, "DNS:localhost,IP:127.0.0.1");
  if (names != nullptr) X509_add_ext(certificate.get(), names, -1);
  X509_EXTENSION_free(names);
  if (X509_sign(certificate.get(), key.get(), EVP_sha256()) == 0) return failed("sign it");
  const Bio certificate_text(BIO_new(BIO_s_mem())), key_text(BIO_new(BIO_s_mem()));
  PEM_write_bio_X509(certificate_text.get(), certificate.get());
  PEM_write_bio_PrivateKey(key_text.get(), key.get(), nullptr, nullptr, 0, nullptr, nullptr);
  return Identity{text_of(certificate_text.get()), text_of(key_text.get())};
}

}  // namespace

Result<Identity> load_identity(const std::string& folder) {
  const std::string certificate = folder + "/page_certificate.pem", key = folder + "/page_key.pem";
  Identity identity{read_file(certificate), read_file(key)};
  if (identity.certificate.empty() != identity.key.empty()) {
    const bool has_key = identity.certificate.empty();
    return Error{Code::Malformed, (has_key ? key : certificate) + " is there without " +
                                      (has_key ? certificate : key) +
                                      "; delete it to have new ones made"};
  }
  if (!identity.certificate.empty()) {
    const auto read = read_certificate(identity.certificate);
    if (!read)
      return Error{Code::Malformed, certificate +
                                        " is no certificate; delete it to have "
                                        "a new one made"};
    const Bio text(BIO_new_mem_buf(identity.key.data(), static_cast<int>(identity.key.size())));
    const Key own(PEM_read_bio_PrivateKey(text.get(), nullptr, nullptr, nullptr));
    if (!own || X509_check_private_key(read.get(), own.get()) != 1)
      return Error{Code::Malformed, key + " is not the key of " + certificate +
                                        "; delete both to have new ones made"};
    return identity;
  }
  auto made = make_identity();
  if (!made) return made;
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) return failed("make " + folder + ": " + error.message());
  for (const auto& [path, text] : {std::pair{key, made->key}, {certificate, made->certificate}})
    if (auto written = write_secret(path, text); !written) return written.error();
  return made;
}

Result<std::string> fingerprint(const std::string& certificate) {
  const auto parsed = read_certificate(certificate);
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest;
  unsigned size = 0;
  if (!parsed || X509_digest(parsed.get(), EVP_sha256(), digest.data(), &size) == 0)
    return failed("read it");
  std::string text;
  for (unsigned i = 0; i < size; ++i) {
    if (i > 0) text += ':';
    text += "0123456789ABCDEF"[digest.at(i) / 16];
    text += "0123456789ABCDEF"[digest.at(i) % 16];
  }
  return text;
}

std::string settings_folder() {
  if (const char* folder = std::getenv("XDG_CONFIG_HOME"); folder != nullptr && *folder == '/')
    return std::string(folder) + "/hypercolumn";
  const char* home = std::getenv("HOME");
  return std::string(home != nullptr ? home : ".") + "/.config/hypercolumn";
}

}  // namespace hc::web
