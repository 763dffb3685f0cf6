// SPDX-License-Identifier: Apache-2.0
// nng (modes ipc, tcp): pair0 sockets, which block and lose nothing, one for each reader; pub0
// would drop. Buffers of 128 messages, of 2 images. Messages are written into nng_msg; what is
// resent is the message that was received last, which is not copied.
#include <nng/nng.h>
#include <nng/protocol/pair0/pair.h>
#include <unistd.h>

#include <atomic>
#include <utility>
#include <vector>

#include "../harness.h"

namespace {

using bench::Setup;

void good(int status, const char* what) {
  if (status != 0) bench::fail(std::string(what) + ": " + nng_strerror(status));
}

nng_socket pair_socket(const Setup& setup) {
  nng_socket socket;
  good(nng_pair0_open(&socket), "nng_pair0_open");
  const int depth = setup.is_small() ? 128 : 2;
  nng_socket_set_int(socket, NNG_OPT_SENDBUF, depth);
  nng_socket_set_int(socket, NNG_OPT_RECVBUF, depth);
  nng_socket_set_size(socket, NNG_OPT_RECVMAXSZ, 0);  // no limit
  return socket;
}

std::string place_of(const Setup& setup, int reader) {
  if (setup.mode == "tcp") return "tcp://127.0.0.1:" + std::to_string(setup.port + reader);
  return "ipc://" + setup.folder + "/" + setup.link + "_" + std::to_string(reader);
}

/// What this process has received last and not sent again yet.
nng_msg*& last_received() {
  static nng_msg* message = nullptr;
  return message;
}

class Publisher final : public bench::Publisher {
 public:
  explicit Publisher(const Setup& setup) : setup_(setup) {
    for (int i = 0; i < setup.readers; ++i) {
      sockets_.push_back(pair_socket(setup));
      auto count = [](nng_pipe, nng_pipe_ev, void* counter) {
        ++*static_cast<std::atomic<int>*>(counter);
      };
      nng_pipe_notify(sockets_.back(), NNG_PIPE_EV_ADD_POST, count, &connected_);
      good(nng_listen(sockets_.back(), place_of(setup, i).c_str(), nullptr, 0), "nng_listen");
    }
  }
  ~Publisher() override {
    for (auto socket : sockets_) nng_close(socket);
  }

  void await_readers() override {
    while (connected_ < setup_.readers) ::usleep(1000);
  }

  std::span<std::byte> loan() override {
    good(nng_msg_alloc(&message_, setup_.bytes), "nng_msg_alloc");
    return {static_cast<std::byte*>(nng_msg_body(message_)), setup_.bytes};
  }

  void publish() override {
    for (std::size_t i = 0; i < sockets_.size(); ++i) {
      nng_msg* one = message_;
      if (i + 1 < sockets_.size()) good(nng_msg_dup(&one, message_), "nng_msg_dup");
      good(nng_sendmsg(sockets_[i], one, 0), "nng_sendmsg");
    }
  }

  void resend() override {
    message_ = std::exchange(last_received(), nullptr);
    if (message_ == nullptr) loan();
    publish();
  }

 private:
  Setup setup_;
  std::vector<nng_socket> sockets_;
  std::atomic<int> connected_ = 0;
  nng_msg* message_ = nullptr;
};

class Subscriber final : public bench::Subscriber {
 public:
  explicit Subscriber(const Setup& setup) : socket_(pair_socket(setup)) {
    const std::string place = place_of(setup, setup.reader);
    nng_socket_set_ms(socket_, NNG_OPT_RECONNMINT, 10);
    good(nng_dial(socket_, place.c_str(), nullptr, NNG_FLAG_NONBLOCK), "nng_dial");
  }
  ~Subscriber() override { nng_close(socket_); }

  std::span<const std::byte> receive() override {
    auto& message = last_received();
    if (message != nullptr) nng_msg_free(message);
    good(nng_recvmsg(socket_, &message, 0), "nng_recvmsg");
    return {static_cast<const std::byte*>(nng_msg_body(message)), nng_msg_len(message)};
  }

 private:
  nng_socket socket_;
};

}  // namespace

int main(int argc, char** argv) {
  return bench::run<Publisher, Subscriber>(argc, argv);
}
