// SPDX-License-Identifier: Apache-2.0
#include <web/identity.h>

#include <openssl/evp.h>
#include <openssl/pem.h>
#include <openssl/x509.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <system_error>

#include <tls/key.h>

namespace hc::web {
namespace {

namespace fs = std::filesystem;

/// Reads an object from PEM; null if there is none. @param free  OpenSSL's destructor of it.
template <typename Object, typename Free>
std::unique_ptr<Object, Free> read_pem(Object* read(BIO*, Object**, pem_password_cb*, void*),
                                       Free free, const std::string& text) {
  const std::unique_ptr<BIO, decltype(&BIO_free)> bio(
      BIO_new_mem_buf(text.data(), static_cast<int>(text.size())), BIO_free);
  return {read(bio.get(), nullptr, nullptr, nullptr), free};
}

auto certificate_of(const std::string& text) {
  return read_pem(PEM_read_bio_X509, X509_free, text);
}

}  // namespace

Result<std::string> load_identity(const std::string& folder) {
  const std::string path = folder + "/page_key.pem";
  std::error_code error;
  fs::create_directories(folder, error);
  if (error)
    return Error{Code::System, "certificate: cannot make " + folder + ": " + error.message()};
  if (auto made = tls::make_key(path); !made) return made.error();
  std::ifstream file(path);
  if (!file)
    return Error{Code::System,
                 path + ": cannot be read: " + std::generic_category().message(errno)};
  const std::string text(std::istreambuf_iterator<char>(file), {});
  const auto certificate = certificate_of(text);
  const auto key = read_pem(PEM_read_bio_PrivateKey, EVP_PKEY_free, text);
  if (!certificate || !key || X509_check_private_key(certificate.get(), key.get()) != 1)
    return Error{Code::Malformed,
                 path + " has no certificate with its key; delete the file to make new ones"};
  return text;
}

std::string fingerprint(const std::string& pem) {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest;
  unsigned size = 0;
  if (const auto certificate = certificate_of(pem))
    X509_digest(certificate.get(), EVP_sha256(), digest.data(), &size);
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
