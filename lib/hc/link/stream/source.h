// SPDX-License-Identifier: Apache-2.0
#pragma once
// Messages out of any descriptor that carries a stream of bytes: pipe, file, terminal, socket, and
// what stdio, file, tcp and unix share beside. Internal. sink.h has the other end.

#include <cstdint>
#include <memory>

#include <hc/link/link.h>
#include <hc/mtp/stream_reader.h>
#include <hc/os/secure_channel.h>

namespace hc::internal {

/// Takes messages from a descriptor whose reads do not wait; those of sockets never do.
class StreamSource final : public Source {
 public:
  /// @param may_await_writer  it is a FIFO, opened by name, perhaps before its first writer.
  StreamSource(ConnectedSocket descriptor, const LinkOptions& options,
               bool may_await_writer = false)
      : descriptor_(std::move(descriptor)),
        may_await_writer_(may_await_writer),
        begin_(::lseek(descriptor_.get(), 0, SEEK_CUR)),
        reader_(options.limits) {}

  Result<Got> take(Message& message) override;
  [[nodiscard]] int descriptor() const override { return descriptor_.get(); }
  [[nodiscard]] Traffic traffic() const override { return {reader_.messages(), reader_.bytes()}; }
  Status resume() override;
  /// Whether nothing has come yet of the next message.
  [[nodiscard]] bool between_messages() const { return reader_.finish().has_value(); }
  /// Whether a part of the next message's header line has come.
  [[nodiscard]] bool in_header() const { return reader_.in_header(); }

 private:
  [[nodiscard]] bool awaits_writer() const;
  Got nothing();
  ssize_t read(std::span<std::byte> space);

  ConnectedSocket descriptor_;
  bool may_await_writer_;
  off_t begin_;            // where in a file the stream begins, -1 in what is none [byte]
  bool is_socket_ = true;  // until a first read says otherwise
  bool is_dry_ = false;    // the last read gave all there was, which has been taken
  int wakes_at_ = 1;       // bytes, in what is a socket
  StreamReader reader_;
};

}  // namespace hc::internal
