// SPDX-License-Identifier: Apache-2.0
#pragma once
// Messages out of a stream that comes in pieces of any size (spec/mtp-1.md). Pure: whoever has a
// descriptor reads into space() and says commit(); large elements land where they will stay.

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
/// Messages own their elements, share memory with one another, and may be held as long as one
/// likes. Memory: one block of 64 KiB, and what the elements need as they come; a message promised
/// but not sent costs 1 MiB at most, or as much as the largest message that did come.
class StreamReader {
 public:
  explicit StreamReader(const Limits& limits = {}) : limits_(limits) {}

  /// Where the next bytes of the stream go; never empty. Changes with commit() and next().
  std::span<std::byte> space();
  /// Says that `size` bytes have been put at the start of space().
  void commit(std::size_t size);

  /// How many bytes of the stream are sure to come before next() has a message: 0 until the head of
  /// a large one is known. [byte]
  [[nodiscard]] std::uint64_t missing() const {
    return state_ == State::Body ? body_size_ - body_filled_ : 0;
  }

  /// Whether a part of a header line has come, and not its end.
  [[nodiscard]] bool in_header() const {
    return state_ == State::Head && begin_ != end_ && unread().find('\n') == std::string_view::npos;
  }

  /// Takes the next whole message; false when more bytes are needed first.
  ///
  /// Errors: Malformed, Unsupported, TooLarge, with rule, field and byte; the same again from then
  /// on, until resume().
  Result<bool> next(Message& message);

  /// To be called at the stream's end, when next() has given false.
  ///
  /// Errors: Truncated when the stream ended inside a message (R2).
  Status finish() const;

  /// Whole messages read so far.
  [[nodiscard]] std::uint64_t messages() const { return messages_; }
  /// Bytes of the stream read so far, those of the messages and of what has come of the next.
  [[nodiscard]] std::uint64_t bytes() const { return byte_; }
  /// Where in the stream the message being read began, or the last one that was refused. [byte]
  [[nodiscard]] std::uint64_t message_begin() const { return message_begin_; }

  /// Looks for the next valid header after an error (R40). The bytes to come are those of the
  /// stream from message_begin() on, once more.
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
  SharedBytes block_;  // the stream from byte_ on is in [begin_, end_)
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
  bool expects_body_ = false;                            // as the last message had one
  std::uint64_t trusted_size_ = std::uint64_t{1} << 20;  // of a body that one allocates at once
};

}  // namespace hc
