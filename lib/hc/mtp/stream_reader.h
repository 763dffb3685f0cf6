// SPDX-License-Identifier: Apache-2.0
#pragma once
// Incremental reader of a stream of messages (spec/mtp-1.md). Pure: the caller reads bytes into
// space() and calls commit(); large elements are received in place.

#include <cstddef>
#include <cstdint>
#include <span>

#include <hc/base/result.h>
#include <hc/mtp/framing.h>
#include <hc/mtp/message.h>
#include <hc/mtp/text.h>

namespace hc {

/// Reads one stream.
///
///     while (true) {
///       auto got = reader.next(message);
///       if (!got) return got.error();
///       if (*got) { use(message); continue; }
///       ssize_t size = ::read(fd, reader.space().data(), reader.space().size());
///       if (size == 0) return reader.finish();
///       reader.commit(size);
///     }
///
/// Messages own their elements, may share memory, and may be stored. Memory: one block of 64 KiB,
/// and the elements as they arrive; a message that is announced but not sent costs 1 MiB at most,
/// or the size of the largest message received.
class StreamReader {
 public:
  explicit StreamReader(const Limits& limits = {}) : limits_(limits) {}

  /// The destination of the next bytes of the stream; never empty. Invalidated by commit() and
  /// next().
  std::span<std::byte> space();
  /// Reports `size` bytes written at the start of space().
  void commit(std::size_t size);

  /// A lower bound of the bytes needed before next() returns a message: 0 until the head of a large
  /// message has been read. [byte]
  [[nodiscard]] std::uint64_t missing() const {
    return state_ == State::Body ? body_size_ - body_filled_ : 0;
  }

  /// Whether a header line has been received only partly.
  [[nodiscard]] bool in_header() const {
    return state_ == State::Head && begin_ != end_ && unread().find('\n') == std::string_view::npos;
  }

  /// Returns the next complete message; false if more bytes are needed.
  ///
  /// Errors: Malformed, Unsupported, TooLarge, with rule, field and byte; repeated on further calls
  /// until resume().
  Result<bool> next(Message& message);

  /// Call it at the end of the stream, after next() has returned false.
  ///
  /// Errors: Truncated when the stream ended inside a message (R2).
  Status finish() const;

  /// Complete messages read so far.
  [[nodiscard]] std::uint64_t messages() const { return messages_; }
  /// Bytes of the stream read so far, including an incomplete message.
  [[nodiscard]] std::uint64_t bytes() const { return byte_; }
  /// Offset of the message being read, or of the one that was refused. [byte]
  [[nodiscard]] std::uint64_t message_begin() const { return message_begin_; }

  /// After an error, searches for the next valid header (R40). The caller supplies the stream again
  /// from message_begin() on.
  void resume();

 private:
  enum class State { Search, Head, Rows, Body, Failed };

  [[nodiscard]] std::string_view unread() const;
  void consume(std::size_t size);
  void search();
  Result<bool> read_head(Message& message);
  Result<bool> read_rows(Message& message);
  Result<bool> read_body(Message& message);
  bool deliver(Message& message, std::span<const std::byte> elements, const SharedBytes& owner);
  void prepare_body(std::uint64_t size);
  void grow_body(std::uint64_t size);

  Limits limits_;
  State state_ = State::Head;
  SharedBytes block_;  // [begin_, end_) holds the stream from byte_ on
  std::size_t begin_ = 0, end_ = 0;
  std::uint64_t byte_ = 0;
  std::uint64_t messages_ = 0;
  std::uint64_t message_begin_ = 0;
  Error error_;

  std::uint64_t elements_begin_ = 0;  // [byte]
  internal::HeaderMemo memo_;
  Header header_;  // of the message whose elements are being read
  TextRows rows_;
  SharedBytes body_;
  std::uint64_t body_capacity_ = 0, body_size_ = 0, body_filled_ = 0;
  bool expects_body_ = false;                            // the last message had a body
  std::uint64_t trusted_size_ = std::uint64_t{1} << 20;  // bodies up to it are allocated at once
};

}  // namespace hc
