// SPDX-License-Identifier: Apache-2.0
#include <hc/mtp/stream_reader.h>

#include <algorithm>
#include <cstring>

#include <hc/mtp/refusal.h>

namespace hc {
namespace {

constexpr std::size_t kBlockBytes = std::size_t{64} << 10;
constexpr std::size_t kMinSpace = 4096;        // minimum size of a read, to limit system calls
constexpr std::size_t kMaxInBlock = 16 << 10;  // elements up to this size stay in the block
constexpr std::size_t kMaxHead = kMaxHeaderBytes + 32;

}  // namespace

std::string_view StreamReader::unread() const {
  return {reinterpret_cast<const char*>(block_.get()) + begin_, end_ - begin_};
}

void StreamReader::consume(std::size_t size) {
  begin_ += size;
  byte_ += size;
}

std::span<std::byte> StreamReader::space() {
  if (state_ == State::Body && body_filled_ < body_size_) {
    if (body_filled_ == body_capacity_) grow_body(body_size_);
    return {body_.get() + body_filled_, std::min(body_capacity_, body_size_) - body_filled_};
  }
  bool shared = block_.use_count() > 1;
  if (begin_ == end_ && !shared) begin_ = end_ = 0;
  bool whole_fits = kBlockBytes - begin_ >= kMaxHead + kMaxInBlock + 2;
  if (block_ == nullptr || kBlockBytes - end_ < kMinSpace || !whole_fits) {
    // Moves the unread bytes to the front; to a new block if messages still refer to this one.
    SharedBytes target = block_ == nullptr || shared ? allocate_bytes(kBlockBytes) : block_;
    if (end_ > begin_) std::memmove(target.get(), block_.get() + begin_, end_ - begin_);
    end_ -= begin_;
    begin_ = 0;
    block_ = std::move(target);
  }
  // If the last message had a separate body, read only the head, so that the elements are not
  // copied.
  bool only_head = state_ == State::Head && begin_ == end_ && expects_body_;
  return {block_.get() + end_, only_head ? kMinSpace : kBlockBytes - end_};
}

void StreamReader::commit(std::size_t size) {
  if (state_ == State::Body && body_filled_ < body_size_) {
    body_filled_ += size;
    byte_ += size;
    HC_CHECK(body_filled_ <= std::min(body_capacity_, body_size_), size);
  } else {
    end_ += size;
    HC_CHECK(end_ <= kBlockBytes, size);
  }
}

Result<bool> StreamReader::next(Message& message) {
  message.elements = {};
  message.owner.reset();  // frees the memory for reuse, unless it is shared
  if (state_ == State::Search) search();
  Result<bool> got = false;
  if (state_ == State::Head) got = read_head(message);
  // Data that follows the head may have been received with it.
  if (got && !*got && state_ == State::Rows) got = read_rows(message);
  if (got && !*got && state_ == State::Body) got = read_body(message);
  if (state_ == State::Failed) return error_;
  if (!got) {
    state_ = State::Failed;
    error_ = got.error();
  }
  return got;
}

Result<bool> StreamReader::read_head(Message& message) {
  message_begin_ = byte_;
  if (begin_ == end_) return false;
  auto line = internal::read_header_line(unread(), limits_, byte_, memo_);
  if (!line) return line.error();
  if (line->bytes == 0) return false;
  header_ = line->header;

  if (internal::has_rows(header_)) {
    consume(line->bytes);
    elements_begin_ = byte_;
    rows_ = TextRows(header_);
    prepare_body(header_.element_bytes());
    state_ = State::Rows;
    return false;
  }

  std::size_t head = line->bytes;
  std::uint64_t length = header_.element_bytes();
  if (internal::is_compressed(header_)) {
    auto part = HC_TRY(internal::read_length_line(unread().substr(head), limits_, byte_ + head));
    if (part.bytes == 0) return false;
    head += part.bytes;
    length = part.length;
  }
  if (length > kMaxInBlock) {
    consume(head);
    elements_begin_ = byte_;
    prepare_body(length);
    state_ = State::Body;
    return false;
  }

  if (unread().size() < head + length) return false;
  const auto end = head + length;
  auto closing = HC_TRY(internal::read_closing(header_, unread().substr(end), byte_ + end));
  if (closing == 0) return false;
  // To align the elements, move them towards the head, which is no longer needed.
  std::byte* elements = block_.get() + begin_ + head;
  std::size_t scalar = internal::is_compressed(header_) ? 1 : size_of(header_.info.scalar);
  if (auto excess = reinterpret_cast<std::uintptr_t>(elements) % scalar; excess != 0) {
    std::memmove(elements - excess, elements, length);
    elements -= excess;
  }
  elements_begin_ = byte_ + head;
  consume(end + closing);
  return deliver(message, {elements, length}, block_);
}

Result<bool> StreamReader::read_rows(Message& message) {
  if (begin_ == end_) return false;
  std::uint64_t scalar = size_of(header_.info.scalar);
  std::uint64_t most = (rows_.count() + unread().size() / 2 + 1) * scalar;
  if (body_capacity_ < body_size_ && body_capacity_ < most) grow_body(most);
  auto used = HC_TRY(rows_.read(unread(), byte_, body_.get() + rows_.count() * scalar));
  consume(used);
  if (!rows_.done()) return false;
  return deliver(message, {body_.get(), body_size_}, body_);
}

Result<bool> StreamReader::read_body(Message& message) {
  if (body_filled_ < body_size_ && begin_ < end_) {
    while (body_capacity_ < std::min<std::uint64_t>(body_size_, body_filled_ + unread().size()))
      grow_body(body_size_);
    std::size_t size = std::min<std::uint64_t>(unread().size(), body_size_ - body_filled_);
    std::memcpy(body_.get() + body_filled_, unread().data(), size);
    body_filled_ += size;
    consume(size);
  }
  if (body_filled_ < body_size_) return false;
  auto closing = HC_TRY(internal::read_closing(header_, unread(), byte_));
  if (closing == 0) return false;
  consume(closing);
  return deliver(message, {body_.get(), body_size_}, body_);
}

bool StreamReader::deliver(Message& message, std::span<const std::byte> elements,
                           const SharedBytes& owner) {
  expects_body_ = owner == body_;
  message.header = header_;
  message.elements = elements;
  message.owner = owner;
  message.byte = elements_begin_;
  trusted_size_ = std::max<std::uint64_t>(trusted_size_, elements.size());
  state_ = State::Head;
  ++messages_;
  return true;
}

void StreamReader::prepare_body(std::uint64_t size) {
  body_size_ = size;
  body_filled_ = 0;
  if (body_.use_count() == 1 && body_capacity_ >= size) return;
  body_capacity_ = std::min(size, trusted_size_);
  body_ = allocate_bytes(body_capacity_);
}

void StreamReader::grow_body(std::uint64_t size) {
  std::uint64_t filled =
      state_ == State::Rows ? rows_.count() * size_of(header_.info.scalar) : body_filled_;
  std::uint64_t capacity =
      std::min(body_size_, std::max(2 * body_capacity_, state_ == State::Rows ? size : 0));
  SharedBytes grown = allocate_bytes(capacity);
  std::memcpy(grown.get(), body_.get(), filled);
  body_ = std::move(grown);
  body_capacity_ = capacity;
}

Status StreamReader::finish() const {
  if (state_ == State::Failed) return error_;
  if (state_ == State::Search || (state_ == State::Head && begin_ == end_)) return {};
  return internal::refusal(Code::Truncated, 2, "stream",
                           "truncated in message " + std::to_string(messages_ + 1),
                           byte_ + (end_ - begin_));
}

void StreamReader::resume() {
  state_ = State::Search;
  byte_ = message_begin_;
  begin_ = end_ = 0;
  block_.reset();
}

void StreamReader::search() {
  while (true) {
    auto text = unread();
    auto feed = text.find('\n');
    if (feed == std::string_view::npos) {
      consume(text.size());
      return;
    }
    // The line feed is kept until the line after it has been checked.
    auto line = internal::read_header_line(text.substr(feed + 1), limits_, 0, memo_);
    if (line && line->bytes == 0) {
      consume(feed);
      return;
    }
    consume(feed + 1);
    if (line) {
      state_ = State::Head;
      return;
    }
  }
}

}  // namespace hc
