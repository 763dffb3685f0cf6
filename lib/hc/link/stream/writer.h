// SPDX-License-Identifier: Apache-2.0
#pragma once
// Writes messages to a descriptor in few system calls: small ones are copied into one buffer, large
// ones are written from where they are. Internal. Of one thread at a time; only close() waits.

#include <cstddef>
#include <cstdint>
#include <vector>

#include <hc/link/stream/parcel.h>
#include <hc/os/secure_channel.h>

namespace hc::internal {

/// The part of a stream that has been begun and is not written yet: a buffer of small messages, and
/// behind them at most one large message that stays where it is.
class StreamWriter {
 public:
  /// The size of the buffer. [byte]
  static constexpr std::size_t kMostGathered = 64 << 10;

  /// Writes to a descriptor from now on. A message that was partly written to another before is
  /// written again, whole, and then those behind it.
  /// @param descriptor  non-blocking, unless it is a socket. -1: none, for now.
  void start(ConnectedSocket descriptor);
  [[nodiscard]] int descriptor() const { return descriptor_.get(); }
  [[nodiscard]] bool empty() const { return gathered() == 0 && large_left_ == 0 && !has_unsent(); }
  /// Bytes that have been written, over all descriptors.
  [[nodiscard]] std::uint64_t total() const { return total_; }
  /// Bytes in the buffer that are not written yet.
  [[nodiscard]] std::size_t gathered() const { return bytes_.size() - written_; }

  /// Messages in the buffer, of which the first may be written in part.
  [[nodiscard]] std::size_t messages() const { return ends_.size(); }

  /// Whether a message of this size [byte] fits into the buffer.
  [[nodiscard]] bool has_room(std::size_t size) const {
    return large_left_ == 0 && size <= Parcel::kMostCopied && gathered() + size <= kMostGathered;
  }
  /// Begins a message: copies it into the buffer where it fits, else keeps it to be written from
  /// where it is; then there must not be another large one. Whether it was copied.
  /// @param message  without an owner its pieces must live until they are written, replaced by
  /// keep()
  ///     or discarded.
  bool add(const Parcel& message);
  /// Whether there is a large message without an owner.
  [[nodiscard]] bool borrows() const { return large_left_ > 0 && large_.owner == nullptr; }
  /// Replaces the large message by a copy with an owner, in pieces of the same sizes.
  void keep(const Parcel& copy) { large_ = copy; }

  /// Writes as much as the descriptor takes; true when that was all.
  ///
  /// Errors: Closed, System (a file then ends with the last whole message). Cost: one system call
  /// where the descriptor takes all of it.
  Result<bool> write();

  /// Discards the last message if nothing of it has been written; false otherwise.
  bool take_back();
  /// Whether a message is written in part.
  [[nodiscard]] bool inside_message() const;
  /// Discards everything; returns the number of messages that were not written whole.
  std::size_t clear();
  /// Ends the stream, so that the reader finds its end, or closes the connection.
  ///
  /// Over a secure channel the reader sends bytes to say that it writes no more. Bytes that reach a
  /// closed socket reset the connection, which would lose what the reader's kernel has not
  /// received; so this waits until it has, at most for `longest`.
  void close(std::chrono::milliseconds longest);

 private:
  [[nodiscard]] bool has_unsent() const {
    return descriptor_.channel && descriptor_.channel->has_unsent();
  }
  /// Bytes written of the message that is written in part.
  [[nodiscard]] std::size_t begun() const {
    return written_ + (large_left_ > 0 ? large_.size() - large_left_ : 0);
  }
  void advance(std::size_t size);
  void forget_written();
  void cut_file() const;

  ConnectedSocket descriptor_;
  bool is_socket_ = false;
  std::vector<std::byte> bytes_;
  std::size_t written_ = 0;        // of bytes_
  std::vector<std::size_t> ends_;  // of the messages in bytes_
  Parcel large_;
  std::size_t large_left_ = 0;  // to be written of it [byte]
  std::uint64_t total_ = 0;
};

}  // namespace hc::internal
