// SPDX-License-Identifier: Apache-2.0
#pragma once
// Messages over any descriptor that carries a stream of bytes: pipe, file, terminal, socket.
// Internal: what stdio, file, tcp and unix share.

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>

#include <hc/link/descriptor.h>
#include <hc/link/link.h>
#include <hc/wire/codec.h>
#include <hc/wire/stream_reader.h>

namespace hc::internal {

using Deadline = std::chrono::steady_clock::time_point;

/// Takes messages from a descriptor whose reads do not wait; those of sockets never do.
class StreamSource final : public Source {
 public:
  /// @param may_await_writer  it is a FIFO, opened by name, perhaps before its first writer.
  StreamSource(Descriptor descriptor, const LinkOptions& options, bool may_await_writer = false)
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

 private:
  [[nodiscard]] bool awaits_writer() const;

  Descriptor descriptor_;
  bool may_await_writer_;
  off_t begin_;            // where in a file the stream begins, -1 in what is none [byte]
  bool is_socket_ = true;  // until a first read says otherwise
  StreamReader reader_;
};

/// Puts messages into a descriptor whose writes do not wait; those of sockets never do.
///
/// A message that was begun is finished, also when it is to stop: the reader could not tell where
/// the next one begins, and would call the stream damaged.
class StreamSink final : public Sink {
 public:
  /// How long a reader may take, after `stop`, for the rest of a message.
  static constexpr std::chrono::seconds kGrace{2};
  /// How often a reader that is waited for is looked after, whether it is still there.
  static constexpr std::chrono::seconds kLookPeriod{1};

  StreamSink(Descriptor descriptor, const LinkOptions& options)
      : descriptor_(std::move(descriptor)), stop_(options.stop) {}

  Status send(const Message& message) override;
  Status close() override;
  [[nodiscard]] Traffic traffic() const override { return traffic_; }

  /// Sends what an encoder made; several sinks can share one encoding.
  Status send_pieces(const Pieces& pieces);
  [[nodiscard]] int descriptor() const { return descriptor_.get(); }

 private:
  Status wait_for_room(bool begun, std::optional<Deadline>& give_up);
  [[nodiscard]] Status look_after_reader() const;

  Descriptor descriptor_;
  int stop_;
  bool is_socket_ = true;  // until a first write says otherwise
  Encoder encoder_;
  Traffic traffic_;
};

/// Lets a pipe hold more than the kernel's 64 KiB; harmless where it is none.
void widen_pipe(int descriptor);

/// How long a TCP peer may leave what it must answer without an answer.
constexpr std::chrono::seconds kVanishTime{4};

/// Whether a socket's peer has not answered for kVanishTime, though asked twice; false where the
/// socket is not TCP.
///
/// Not TCP_USER_TIMEOUT, which also ends the link to a reader that is there and answers, but is
/// slow and has no room for 4 s.
bool has_vanished(int socket);

/// A descriptor for what `number` is open on, whose reads and writes do not wait (but those of a
/// socket are to be asked not to), without changing that for the other processes that share it.
Result<Descriptor> reopen_without_waiting(int number, int access_mode);

/// The pauses between tries at what comes about by itself: 1 ms, and each twice the last to 200 ms.
class Pauses {
 public:
  /// Errors: Stopped when `stop` is readable.
  Status next(int stop);

 private:
  std::chrono::milliseconds pause_{1};
};

/// Waits until `descriptor` has one of the poll events; false when `deadline` passes first.
///
/// Errors: Stopped when `stop` is readable and the descriptor has none of the events; System.
Result<bool> wait_for(int descriptor, short events, int stop,
                      std::optional<Deadline> deadline = std::nullopt);

}  // namespace hc::internal
