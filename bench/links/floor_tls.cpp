// SPDX-License-Identifier: Apache-2.0
// A floor: bytes of known size over TLS 1.3 on loopback, by OpenSSL alone, with what it chooses:
// cipher, records of 16 KiB, a copy of each. One SSL_write a message and reader, and reads into a
// buffer as large as one image. Blocking, no framing. The key is FOLDER/key.pem.
#include <algorithm>
#include <memory>
#include <thread>
#include <vector>

#include <openssl/ssl.h>

#include "harness.h"
#include "sockets.h"

namespace {

using bench::Setup;

struct Free {
  void operator()(SSL_CTX* context) const { SSL_CTX_free(context); }
  void operator()(SSL* session) const { SSL_free(session); }
};
using Session = std::unique_ptr<SSL, Free>;

std::unique_ptr<SSL_CTX, Free> make_context(const Setup& setup) {
  std::unique_ptr<SSL_CTX, Free> context(SSL_CTX_new(TLS_method()));
  const std::string key = setup.folder + "/key.pem";
  SSL_CTX_set_min_proto_version(context.get(), TLS1_3_VERSION);
  if (SSL_CTX_use_certificate_file(context.get(), key.c_str(), SSL_FILETYPE_PEM) != 1 ||
      SSL_CTX_use_PrivateKey_file(context.get(), key.c_str(), SSL_FILETYPE_PEM) != 1)
    bench::fail("key " + key);
  return context;
}

Session secure(SSL_CTX* context, int socket, int (*shake_hands)(SSL*)) {
  Session session(SSL_new(context));
  SSL_set_fd(session.get(), socket);
  if (shake_hands(session.get()) != 1) bench::fail("handshake");
  return session;
}

class Publisher final : public bench::Publisher {
 public:
  explicit Publisher(const Setup& setup)
      : context_(make_context(setup)),
        readers_(setup.readers),
        listening_(bench::listen(setup)),
        bytes_(setup.bytes) {}

  void await_readers() override {
    while (static_cast<int>(peers_.size()) < readers_)
      peers_.push_back(secure(context_.get(), bench::accept(listening_), SSL_accept));
  }

  std::span<std::byte> loan() override { return bytes_; }

  void publish() override {
    for (const auto& peer : peers_)
      if (SSL_write(peer.get(), bytes_.data(), static_cast<int>(bytes_.size())) <= 0)
        bench::fail("SSL_write");
  }

 private:
  std::unique_ptr<SSL_CTX, Free> context_;
  int readers_, listening_;
  std::vector<Session> peers_;
  std::vector<std::byte> bytes_;
};

class Subscriber final : public bench::Subscriber {
 public:
  explicit Subscriber(const Setup& setup) : context_(make_context(setup)), bytes_(setup.bytes) {
    const int socket = bench::connect(setup);
    // The other side may be shaking hands as a client too.
    client_ =
        std::thread([this, socket] { session_ = secure(context_.get(), socket, SSL_connect); });
  }
  ~Subscriber() override {
    if (client_.joinable()) client_.join();
  }

  std::span<const std::byte> receive() override {
    if (client_.joinable()) client_.join();
    for (std::size_t at = 0; at < bytes_.size();) {
      const int size =
          SSL_read(session_.get(), bytes_.data() + at,
                   static_cast<int>(std::min<std::size_t>(bytes_.size() - at, 1 << 30)));
      if (size <= 0) bench::fail("SSL_read");
      at += static_cast<std::size_t>(size);
    }
    return bytes_;
  }

 private:
  std::unique_ptr<SSL_CTX, Free> context_;
  std::thread client_;
  Session session_;
  std::vector<std::byte> bytes_;
};

}  // namespace

int main(int argc, char** argv) {
  return bench::run<Publisher, Subscriber>(argc, argv);
}
