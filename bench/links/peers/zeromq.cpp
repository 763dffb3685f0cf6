// SPDX-License-Identifier: Apache-2.0
// ZeroMQ (modes ipc, tcp): PUSH and PULL, which block and lose nothing; XPUB with NODROP and SUB
// for several readers. Default queues (1000) and batching for small messages, 4 deep for images,
// whose default would hold 3 GB. Images are written into zmq_msg_t; resent ones are not copied.
#include <zmq.h>

#include <cerrno>
#include <vector>

#include "../harness.h"

namespace {

using bench::Setup;

void* socket_of(const Setup& setup, int kind) {
  static void* const context = zmq_ctx_new();
  void* socket = zmq_socket(context, kind);
  const int no_linger = 0, depth = 4, yes = 1;
  zmq_setsockopt(socket, ZMQ_LINGER, &no_linger, sizeof no_linger);
  if (!setup.is_small()) {
    zmq_setsockopt(socket, ZMQ_SNDHWM, &depth, sizeof depth);
    zmq_setsockopt(socket, ZMQ_RCVHWM, &depth, sizeof depth);
  }
  if (kind == ZMQ_XPUB) {
    zmq_setsockopt(socket, ZMQ_XPUB_NODROP, &yes, sizeof yes);
    // Each subscription is reported, not only the first, so that await_readers() can count.
    zmq_setsockopt(socket, ZMQ_XPUB_VERBOSE, &yes, sizeof yes);
  }
  if (kind == ZMQ_SUB) zmq_setsockopt(socket, ZMQ_SUBSCRIBE, "", 0);
  return socket;
}

std::string place_of(const Setup& setup) {
  if (setup.mode == "tcp") return "tcp://127.0.0.1:" + std::to_string(setup.port);
  return "ipc://" + setup.folder + "/" + setup.link;
}

class Publisher final : public bench::Publisher {
 public:
  explicit Publisher(const Setup& setup)
      : setup_(setup),
        again_(setup.bytes),
        socket_(socket_of(setup, setup.readers == 1 ? ZMQ_PUSH : ZMQ_XPUB)) {
    bench::require(zmq_bind(socket_, place_of(setup).c_str()), "zmq_bind");
  }
  ~Publisher() override { zmq_close(socket_); }

  void await_readers() override {
    if (setup_.readers == 1) return;
    char subscription[8];
    for (int i = 0; i < setup_.readers; ++i)
      bench::require(zmq_recv(socket_, subscription, sizeof subscription, 0), "zmq_recv");
  }

  std::span<std::byte> loan() override {
    zmq_msg_init_size(&message_, setup_.bytes);
    return {static_cast<std::byte*>(zmq_msg_data(&message_)), setup_.bytes};
  }

  void publish() override { bench::require(zmq_msg_send(&message_, socket_, 0), "zmq_msg_send"); }

  void resend() override {
    if (setup_.is_small()) {
      bench::require(zmq_send(socket_, again_.data(), again_.size(), 0), "zmq_send");
      return;
    }
    zmq_msg_init_data(&message_, again_.data(), again_.size(), nullptr, nullptr);
    publish();
  }

 private:
  Setup setup_;
  std::vector<std::byte> again_;
  void* socket_;
  zmq_msg_t message_{};
};

class Subscriber final : public bench::Subscriber {
 public:
  explicit Subscriber(const Setup& setup)
      : socket_(socket_of(setup, setup.readers == 1 ? ZMQ_PULL : ZMQ_SUB)) {
    zmq_msg_init(&message_);
    bench::require(zmq_connect(socket_, place_of(setup).c_str()), "zmq_connect");
  }
  ~Subscriber() override {
    zmq_msg_close(&message_);
    zmq_close(socket_);
  }

  std::span<const std::byte> receive() override {
    bench::require(zmq_msg_recv(&message_, socket_, 0), "zmq_msg_recv");
    return {static_cast<const std::byte*>(zmq_msg_data(&message_)), zmq_msg_size(&message_)};
  }

 private:
  void* socket_;
  zmq_msg_t message_{};
};

}  // namespace

int main(int argc, char** argv) {
  return bench::run<Publisher, Subscriber>(argc, argv);
}
