// SPDX-License-Identifier: Apache-2.0
// Floors: bytes of known size over a pipe, a Unix socket or TCP (modes pipe, unix, tcp); one writev
// a message and reader, and reads into a buffer as large as one image. Blocking, no framing.
#include <fcntl.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <vector>

#include "harness.h"
#include "sockets.h"

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

class Publisher final : public bench::Publisher {
 public:
  explicit Publisher(const Setup& setup) : readers_(setup.readers), bytes_(setup.bytes) {
    if (setup.mode == "pipe") {
      for (int i = 0; i < readers_; ++i) peers_.push_back(open_pipe(setup, i));
      return;
    }
    listening_ = bench::listen(setup);
  }

  void await_readers() override {
    while (static_cast<int>(peers_.size()) < readers_) peers_.push_back(bench::accept(listening_));
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

 private:
  int readers_, listening_ = -1;
  std::vector<int> peers_;
  std::vector<std::byte> bytes_;
};

class Subscriber final : public bench::Subscriber {
 public:
  explicit Subscriber(const Setup& setup)
      : bytes_(setup.bytes), buffer_(std::max(setup.bytes, std::size_t{1} << 16)) {
    descriptor_ = setup.mode == "pipe" ? open_pipe(setup, setup.reader) : bench::connect(setup);
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
