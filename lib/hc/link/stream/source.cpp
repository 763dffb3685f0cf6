// SPDX-License-Identifier: Apache-2.0
#include <hc/link/stream/source.h>

#include <sys/socket.h>
#include <sys/stat.h>

#include <utility>

namespace hc::internal {
Result<Got> StreamSource::take(Message& message) {
  while (true) {
    auto got = HC_TRY(reader_.next(message));
    if (got) return Got::Message;
    // The last read took everything, so another one would most likely find nothing.
    if (std::exchange(is_dry_, false) && between_messages()) return Got::Nothing;
    auto space = reader_.space();
    ssize_t size = read(space);
    const SecureChannel* channel = descriptor_.channel.get();
    if (size < 0 && errno == ENOTSOCK && is_socket_) {
      is_socket_ = false;
      continue;
    }
    if (size > 0) {
      reader_.commit(static_cast<std::size_t>(size));
      is_dry_ = is_socket_ && static_cast<std::size_t>(size) < space.size() &&
                (channel == nullptr || !channel->has_unread());
      continue;
    }
    if (size < 0 && errno == EINTR) continue;
    if (size < 0 && errno == EAGAIN) return Got::Nothing;
    // A peer that is killed while it has unread bytes resets the connection: the end of its stream.
    if (size < 0 && (channel != nullptr || errno != ECONNRESET)) {
      auto error = channel != nullptr ? channel->failure() : system_error("read", "");
      if (error.code == Code::Closed && !between_messages()) error.code = Code::Truncated;
      return error;
    }
    if (size == 0 && awaits_writer()) return Got::Nothing;
    HC_TRY(reader_.finish());
    return Got::End;
  }
}

ssize_t StreamSource::read(std::span<std::byte> space) {
  if (descriptor_.channel) return descriptor_.channel->read(space);
  return is_socket_ ? ::recv(descriptor_.get(), space.data(), space.size(), MSG_DONTWAIT)
                    : ::read(descriptor_.get(), space.data(), space.size());
}

bool StreamSource::awaits_writer() const {
  // A read returns 0 both before the first writer and after the last one; poll() differs.
  pollfd polled{descriptor_.get(), POLLIN, 0};
  return may_await_writer_ && reader_.bytes() == 0 && ::poll(&polled, 1, 0) == 0;
}

Status StreamSource::resume() {
  // Both the reader and the file continue at the beginning of the refused message.
  auto begin = begin_ + static_cast<off_t>(reader_.message_begin());
  struct stat status {};
  if (::fstat(descriptor_.get(), &status) != 0 || !S_ISREG(status.st_mode)) return Source::resume();
  HC_TRY(system_call("lseek", "", [&] { return ::lseek(descriptor_.get(), begin, SEEK_SET); }));
  reader_.resume();
  return {};
}

}  // namespace hc::internal
