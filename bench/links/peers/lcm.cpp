// SPDX-License-Identifier: Apache-2.0
// LCM: udpm with ttl 0, its way between processes. Its publisher never waits, so what a reader's
// socket cannot hold is lost, and only round trips are measured. A message is copied in its
// handler, behind which it is not valid, as generated decoders do.
#include <lcm/lcm.h>

#include <vector>

#include "../harness.h"

namespace {

using bench::Setup;

lcm_t* create() {
  lcm_t* lcm = lcm_create("udpm://239.255.76.67:7667?ttl=0&recv_buf_size=4000000");
  if (lcm == nullptr) bench::fail("lcm_create");
  return lcm;
}

class Publisher final : public bench::Publisher {
 public:
  explicit Publisher(const Setup& setup) : lcm_(create()), link_(setup.link), bytes_(setup.bytes) {}
  ~Publisher() override { lcm_destroy(lcm_); }

  std::span<std::byte> loan() override { return bytes_; }

  void publish() override {
    auto size = static_cast<unsigned>(bytes_.size());
    bench::require(lcm_publish(lcm_, link_.c_str(), bytes_.data(), size), "lcm_publish");
  }

 private:
  lcm_t* lcm_;
  std::string link_;
  std::vector<std::byte> bytes_;
};

class Subscriber final : public bench::Subscriber {
 public:
  explicit Subscriber(const Setup& setup) : lcm_(create()) {
    lcm_subscribe(
        lcm_, setup.link.c_str(),
        [](const lcm_recv_buf_t* buffer, const char*, void* to) {
          const auto* data = static_cast<const std::byte*>(buffer->data);
          static_cast<std::vector<std::byte>*>(to)->assign(data, data + buffer->data_size);
        },
        &message_);
  }
  ~Subscriber() override { lcm_destroy(lcm_); }

  std::span<const std::byte> receive() override {
    bench::require(lcm_handle(lcm_), "lcm_handle");
    return message_;
  }

 private:
  lcm_t* lcm_;
  std::vector<std::byte> message_;
};

}  // namespace

int main(int argc, char** argv) {
  return bench::run<Publisher, Subscriber>(argc, argv);
}
