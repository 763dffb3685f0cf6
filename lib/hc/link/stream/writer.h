// SPDX-License-Identifier: Apache-2.0
#pragma once
// Writes messages to a descriptor in few system calls: small ones are copied into one buffer, large
// ones are written in place. Internal. Used by one thread at a time; only close() waits.

#include <cstddef>
#include <cstdint>
#include <vector>

#include <hc/link/stream/parcel.h>
#include <hc/os/secure_channel.h>

namespace hc::internal {

/// The next messages of a stream: a buffer of small ones, then at most one large one in place.
class StreamWriter {
 public:
  /// The size of the buffer [byte].
  static constexpr std::size_t kMostGathered = 64 << 10;

  /// Writes to a descriptor from now on. A message that was partly written to the former descriptor
  /// is written again from its beginning.
  /// @param descriptor  non-blocking, unless it is a socket. -1: none, for now.
  void start(ConnectedSocket descriptor);
  [[nodiscard]] int descriptor() const { return descriptor_.get(); }
  [[nodiscard]] bool empty() const { return gathered() == 0 && large_left_ == 0 && !has_unsent(); }
  /// Bytes written to all descriptors so far.
  [[nodiscard]] std::uint64_t total() const { return total_; }
  /// Bytes in the buffer still to be written.
  [[nodiscard]] std::size_t gathered() const { return bytes_.size() - written_; }

  /// Messages in the buffer; the first may be partly written.
  [[nodiscard]] std::size_t messages() const { return ends_.size(); }

  /// Whether a message of this size [byte] fits into the buffer.
  [[nodiscard]] bool has_room(std::size_t size) const {
    return large_left_ == 0 && size <= Parcel::kMostCopied && gathered() + size <= kMostGathered;
  }
  /// Adds a message: copies it into the buffer if it fits, else refers to it; then there must not
  /// be another large one. Returns whether it was copied.
  /// @param message  without an owner, its pieces must live until they are written, replaced by
  ///     keep(), or discarded.
  bool add(const Parcel& message);
  /// Whether it refers to a large message without an owner.
  [[nodiscard]] bool borrows() const { return large_left_ > 0 && large_.owner == nullptr; }
  /// Replaces the large message by a copy with an owner, in pieces of the same sizes.
  void keep(const Parcel& copy) { large_ = copy; }

  /// Writes as much as the descriptor takes; true if that was everything.
  ///
  /// Errors: Closed, System (a file then ends with the last complete message). Cost: one system
  /// call if the descriptor takes everything.
  Result<bool> write();

  /// Discards the last message; false if it is partly written.
  bool take_back();
  /// Whether a message is partly written.
  [[nodiscard]] bool inside_message() const;
  /// Discards everything; returns the number of messages that were not written completely.
  std::size_t clear();
  /// Ends the stream and closes the descriptor. Over a secure channel the reader answers, which
  /// resets a connection that is closed; so this waits for the acknowledgement of all bytes before,
  /// at most for `longest`.
  void close(std::chrono::milliseconds longest);

 private:
  [[nodiscard]] bool has_unsent() const {
    return descriptor_.channel && descriptor_.channel->has_unsent();
  }
  /// Bytes written of the message that is partly written.
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
  std::size_t large_left_ = 0;  // still to be written [byte]
  std::uint64_t total_ = 0;
};

}  // namespace hc::internal
