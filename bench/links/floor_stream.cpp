// SPDX-License-Identifier: Apache-2.0
// Floors: bytes of known size over a pipe, a Unix socket or TCP (modes pipe, unix, tcp); one writev
// a message and reader, and reads into a buffer as large as one image. Blocking, no framing.
#include <fcntl.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <vector>

#include "harness.h"

namespace {

using bench::require;
using bench::Setup;

constexpr int kPipeBytes = 1 << 20;  // as our own pipes

int open_pipe(const Setup& setup, int reader) {
  std::string path = setup.folder + "/" + setup.link + "_" + std::to_string(reader);
  if (::mkfifo(path.c_str(), 0600) != 0 && errno != EEXIST) bench::fail("mkfifo " + path);
  // For both directions, so that opening waits for nobody.
  int pipe = require(::open(path.c_str(), O_RDWR), "open " + path);
  require(::fcntl(pipe, F_SETPIPE_SZ, kPipeBytes), "F_SETPIPE_SZ");
  return pipe;
}

/// A socket and its address: on loopback, or a name in the abstract namespace.
struct Socket {
  explicit Socket(const Setup& setup) {
    bool is_tcp = setup.mode == "tcp";
    descriptor = require(::socket(is_tcp ? AF_INET : AF_UNIX, SOCK_STREAM, 0), "socket");
    if (is_tcp) {
      auto& in = reinterpret_cast<sockaddr_in&>(address);
      in.sin_family = AF_INET;
      in.sin_port = htons(static_cast<std::uint16_t>(setup.port));
      in.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
      size = sizeof in;
      int yes = 1;
      ::setsockopt(descriptor, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    } else {
      auto& un = reinterpret_cast<sockaddr_un&>(address);
      un.sun_family = AF_UNIX;
      std::string name = "hc_bench_" + setup.link;
      std::memcpy(un.sun_path + 1, name.data(), std::min(name.size(), sizeof un.sun_path - 1));
      size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + name.size());
    }
  }
  [[nodiscard]] const sockaddr* place() const {
    return reinterpret_cast<const sockaddr*>(&address);
  }

  int descriptor = -1;
  sockaddr_storage address{};
  socklen_t size = 0;
};

/// TCP would hold small messages back; Unix sockets have no such option.
void send_at_once(int socket) {
  int yes = 1;
  ::setsockopt(socket, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
}

class Publisher final : public bench::Publisher {
 public:
  explicit Publisher(const Setup& setup) : readers_(setup.readers), bytes_(setup.bytes) {
    if (setup.mode == "pipe") {
      for (int i = 0; i < readers_; ++i) peers_.push_back(open_pipe(setup, i));
      return;
    }
    Socket socket(setup);
    listening_ = socket.descriptor;
    require(::bind(listening_, socket.place(), socket.size), "bind");
    require(::listen(listening_, readers_), "listen");
  }

  void await_readers() override {
    while (static_cast<int>(peers_.size()) < readers_) {
      peers_.push_back(require(::accept(listening_, nullptr, nullptr), "accept"));
      send_at_once(peers_.back());
    }
  }

  std::span<std::byte> loan() override { return bytes_; }

  void publish() override {
    for (int peer : peers_) {
      for (std::size_t sent = 0; sent < bytes_.size();) {
        iovec part{bytes_.data() + sent, bytes_.size() - sent};
        ssize_t size = ::writev(peer, &part, 1);
        if (size < 0) bench::fail("writev");
        sent += static_cast<std::size_t>(size);
      }
    }
  }

  void resend() override { publish(); }

 private:
  int readers_, listening_ = -1;
  std::vector<int> peers_;
  std::vector<std::byte> bytes_;
};

class Subscriber final : public bench::Subscriber {
 public:
  explicit Subscriber(const Setup& setup)
      : bytes_(setup.bytes), buffer_(std::max(setup.bytes, std::size_t{1} << 16)) {
    if (setup.mode == "pipe") {
      descriptor_ = open_pipe(setup, setup.reader);
      return;
    }
    for (int tries = 0;; ++tries) {
      Socket socket(setup);
      descriptor_ = socket.descriptor;
      if (::connect(descriptor_, socket.place(), socket.size) == 0) break;
      if (tries == 1000) bench::fail("connect");
      ::close(descriptor_);
      ::usleep(10'000);
    }
    send_at_once(descriptor_);
  }

  std::span<const std::byte> receive() override {
    if (begin_ == end_) begin_ = end_ = 0;
    if (buffer_.size() - begin_ < bytes_) {
      std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
      end_ -= begin_;
      begin_ = 0;
    }
    while (end_ - begin_ < bytes_) {
      ssize_t size = ::read(descriptor_, buffer_.data() + end_, buffer_.size() - end_);
      if (size <= 0) bench::fail("read");
      end_ += static_cast<std::size_t>(size);
    }
    begin_ += bytes_;
    return {buffer_.data() + begin_ - bytes_, bytes_};
  }

 private:
  int descriptor_ = -1;
  std::size_t bytes_, begin_ = 0, end_ = 0;
  std::vector<std::byte> buffer_;
};

}  // namespace

int main(int argc, char** argv) {
  return bench::run<Publisher, Subscriber>(argc, argv);
}
