// SPDX-License-Identifier: Apache-2.0
#pragma once
// Writes messages to a descriptor in as few system calls as can be: small ones are gathered, large
// ones go from where they are. Internal. Not for several threads at once; only close() waits.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include <hc/mtp/codec.h>
#include <hc/os/secure_channel.h>

namespace hc::internal {

inline std::size_t size_of(const Pieces& pieces) {
  return pieces[0].size() + pieces[1].size() + pieces[2].size();
}

/// What of a stream has been begun and is not written yet: gathered messages, and behind them at
/// most one large message that stays where it is.
class StreamWriter {
 public:
  /// Messages up to this size are copied, which takes no longer than a system call. [byte]
  static constexpr std::size_t kMostCopied = 8 << 10;
  /// So much is gathered at most. [byte]
  static constexpr std::size_t kMostGathered = 64 << 10;

  /// Writes to a descriptor from now on. Where there was another before, the message that was begun
  /// on it is to be written again, whole, and those behind it.
  /// @param descriptor  its writes do not wait; those of sockets never do. -1: none, for now.
  void start(ConnectedSocket descriptor);
  [[nodiscard]] int descriptor() const { return descriptor_.get(); }
  [[nodiscard]] bool is_socket() const { return is_socket_; }
  [[nodiscard]] bool empty() const { return gathered() == 0 && large_left_ == 0 && !has_unsent(); }
  /// Of gathered messages, not written yet. [byte]
  [[nodiscard]] std::size_t gathered() const { return bytes_.size() - written_; }

  /// Gathered messages, of which the first may be written in part.
  [[nodiscard]] std::size_t messages() const { return ends_.size(); }

  /// Whether a message of so many bytes can be gathered now.
  [[nodiscard]] bool has_room(std::size_t size) const {
    return large_left_ == 0 && size <= kMostCopied && gathered() + size <= kMostGathered;
  }
  /// Begins a message: gathers it where there is room, else has it written from where it is, for
  /// which no other large one may be there. Whether it has been gathered.
  /// @param keeper  keeps the pieces alive; null: the caller does, until they are written, kept by
  ///     keep(), or forgotten.
  bool add(const Pieces& pieces, const std::shared_ptr<const void>& keeper);
  /// Whether there is a large message that its caller keeps alive.
  [[nodiscard]] bool borrows() const { return large_left_ > 0 && keeper_ == nullptr; }
  /// Has a copy stand for the large message, with pieces of the same sizes.
  void keep(const Pieces& pieces, std::shared_ptr<const void> keeper);

  /// Writes what can be written now; true when that was all.
  ///
  /// Errors: Closed, System (a file then ends with the last whole message). Cost: one system call
  /// where the descriptor takes all of it.
  Result<bool> write();

  /// Forgets the last message, if nothing of it has been written; false when it was begun.
  bool take_back();
  /// Whether a message is written in part.
  [[nodiscard]] bool inside_message() const;
  /// Forgets everything; gives how many messages that were not written whole.
  std::size_t clear();
  /// Ends the stream, so that the reader finds its end, or the connection.
  ///
  /// Over a secure channel a reader says by bytes that it writes no more. Bytes that reach a closed
  /// socket reset the connection, and what the reader's kernel has not received yet is lost; so it
  /// is waited for.
  /// @param longest  to wait
  void close(std::chrono::milliseconds longest);

 private:
  [[nodiscard]] bool has_unsent() const {
    return descriptor_.channel && descriptor_.channel->has_unsent();
  }
  /// Of the message that is written in part. [byte]
  [[nodiscard]] std::size_t begun() const {
    return written_ + (large_left_ > 0 ? size_of(large_) - large_left_ : 0);
  }
  void gather(const Pieces& pieces);
  void advance(std::size_t size);
  void forget_written();
  void cut_file() const;

  ConnectedSocket descriptor_;
  bool is_socket_ = false;
  std::vector<std::byte> bytes_;
  std::size_t written_ = 0;        // of bytes_
  std::vector<std::size_t> ends_;  // of the messages in bytes_
  Pieces large_;
  std::size_t large_left_ = 0;  // [byte]
  std::shared_ptr<const void> keeper_;
};

}  // namespace hc::internal
