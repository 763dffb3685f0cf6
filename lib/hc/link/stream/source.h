// SPDX-License-Identifier: Apache-2.0
#pragma once
// Reads messages from a stream of bytes: pipe, file, terminal or socket. Internal.

#include <cstdint>
#include <memory>

#include <hc/link/link.h>
#include <hc/mtp/stream_reader.h>
#include <hc/os/secure_channel.h>

namespace hc::internal {

/// Takes messages from a descriptor that is non-blocking or a socket.
class StreamSource final : public Source {
 public:
  /// @param may_await_writer  the descriptor is a FIFO, opened perhaps before its first writer.
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
  /// Whether no byte of the next message has arrived.
  [[nodiscard]] bool between_messages() const { return reader_.finish().has_value(); }
  /// Whether the header line of the next message has arrived in part.
  [[nodiscard]] bool in_header() const { return reader_.in_header(); }

 private:
  [[nodiscard]] bool awaits_writer() const;
  ssize_t read(std::span<std::byte> space);

  ConnectedSocket descriptor_;
  bool may_await_writer_;
  off_t begin_;            // of the stream in the file; -1: not a file [byte]
  bool is_socket_ = true;  // until the first read fails with ENOTSOCK
  bool is_dry_ = false;    // the last read took everything
  StreamReader reader_;
};

}  // namespace hc::internal
