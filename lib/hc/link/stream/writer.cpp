// SPDX-License-Identifier: Apache-2.0
#include <hc/link/stream/writer.h>

#include <pthread.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <ctime>
#include <tuple>

#include <hc/os/socket.h>

namespace hc::internal {
namespace {

/// Suppresses SIGPIPE, which a write to a pipe without a reader raises, for programs that do not
/// ignore it. Sockets have a flag for that.
class NoPipeSignal {
 public:
  NoPipeSignal() {
    ::sigemptyset(&pipe_);
    ::sigaddset(&pipe_, SIGPIPE);
    ::pthread_sigmask(SIG_BLOCK, &pipe_, &before_);
  }
  ~NoPipeSignal() {
    if (::sigismember(&before_, SIGPIPE) == 0) ::pthread_sigmask(SIG_SETMASK, &before_, nullptr);
  }
  NoPipeSignal(const NoPipeSignal&) = delete;
  NoPipeSignal& operator=(const NoPipeSignal&) = delete;

  /// Consumes the raised signal, so that it is not delivered later.
  void take() const {
    constexpr timespec kNow{};
    ::sigtimedwait(&pipe_, nullptr, &kNow);
  }

 private:
  sigset_t pipe_, before_;
};

ssize_t write_to_pipe(int descriptor, const iovec* parts, std::size_t count) {
  NoPipeSignal guard;
  ssize_t size = ::writev(descriptor, parts, static_cast<int>(count));
  if (size < 0 && errno == EPIPE) {
    guard.take();
    errno = EPIPE;
  }
  return size;
}

ssize_t write_to_socket(int descriptor, iovec* parts, std::size_t count) {
  msghdr header{};
  header.msg_iov = parts;
  header.msg_iovlen = count;
  return ::sendmsg(descriptor, &header, MSG_NOSIGNAL | MSG_DONTWAIT);
}

bool is_socket(int descriptor) {
  int type = 0;
  socklen_t size = sizeof type;
  return ::getsockopt(descriptor, SOL_SOCKET, SO_TYPE, &type, &size) == 0;
}

}  // namespace

bool StreamWriter::add(const Parcel& message) {
  const auto size = message.size();
  if (has_room(size)) {
    if (bytes_.capacity() == 0) bytes_.reserve(kMostGathered + Parcel::kMostCopied);
    for (auto piece : message.pieces) bytes_.insert(bytes_.end(), piece.begin(), piece.end());
    ends_.push_back(bytes_.size());
    return true;
  }
  HC_CHECK(large_left_ == 0, large_left_);
  large_left_ = size;
  large_ = message;
  return false;
}

Result<bool> StreamWriter::write() {
  while (!empty()) {
    std::array<iovec, 1 + std::tuple_size_v<Pieces>> parts{};
    std::size_t used = 0;
    auto add = [&](std::span<const std::byte> part) {
      if (!part.empty()) parts.at(used++) = {const_cast<std::byte*>(part.data()), part.size()};
    };
    add(std::span(bytes_).subspan(written_));
    std::size_t skip = large_left_ == 0 ? 0 : large_.size() - large_left_;
    for (auto piece : large_.pieces) {
      if (large_left_ == 0) break;
      add(piece.subspan(std::min(skip, piece.size())));
      skip -= std::min(skip, piece.size());
    }
    auto* channel = descriptor_.channel.get();
    ssize_t size = channel != nullptr ? channel->write(std::span(parts).first(used))
                   : is_socket_       ? write_to_socket(descriptor_.get(), parts.data(), used)
                                      : write_to_pipe(descriptor_.get(), parts.data(), used);
    if (size >= 0) {
      advance(static_cast<std::size_t>(size));
    } else if (errno == EAGAIN || errno == EWOULDBLOCK) {
      forget_written();
      return false;
    } else if (errno != EINTR) {
      int number = errno;
      forget_written();
      cut_file();
      return channel != nullptr ? channel->failure() : system_error("write", "", number);
    }
  }
  return true;
}

void StreamWriter::advance(std::size_t size) {
  total_ += size;
  std::size_t small = std::min(size, gathered());
  written_ += small;
  if (gathered() == 0) {
    bytes_.clear();
    ends_.clear();
    written_ = 0;
  }
  large_left_ -= size - small;
  if (large_left_ == 0) large_ = {};
}

/// Removes completely written messages from the buffer.
void StreamWriter::forget_written() {
  auto first = std::upper_bound(ends_.begin(), ends_.end(), written_);
  std::size_t begin = first == ends_.begin() ? 0 : *(first - 1);
  bytes_.erase(bytes_.begin(), bytes_.begin() + static_cast<std::ptrdiff_t>(begin));
  ends_.erase(ends_.begin(), first);
  for (auto& end : ends_) end -= begin;
  written_ -= begin;
}

/// Removes the beginning of a message that could not be written completely, for lack of space.
void StreamWriter::cut_file() const {
  const int file = descriptor_.get();
  const auto end = ::lseek(file, 0, SEEK_CUR);
  struct stat status {};
  if (begun() == 0 || ::fstat(file, &status) != 0 || !S_ISREG(status.st_mode) ||
      status.st_size != end)
    return;
  const auto whole = end - static_cast<off_t>(begun());
  if (::ftruncate(file, whole) == 0) ::lseek(file, whole, SEEK_SET);
}

bool StreamWriter::inside_message() const {
  return begun() > 0 || has_unsent();
}

bool StreamWriter::take_back() {
  if (large_left_ > 0) {
    if (large_left_ < large_.size()) return false;
    large_left_ = 0;
    large_ = {};
    return true;
  }
  if (ends_.empty()) return false;
  std::size_t begin = ends_.size() == 1 ? 0 : ends_[ends_.size() - 2];
  if (written_ > begin) return false;
  bytes_.resize(begin);
  ends_.pop_back();
  return true;
}

void StreamWriter::start(ConnectedSocket descriptor) {
  descriptor_ = std::move(descriptor);
  is_socket_ = internal::is_socket(descriptor_.get());
  written_ = 0;
  if (large_left_ > 0) large_left_ = large_.size();
}

std::size_t StreamWriter::clear() {
  std::size_t count = ends_.size() + (large_left_ > 0 ? 1 : 0);
  bytes_.clear();
  ends_.clear();
  written_ = large_left_ = 0;
  large_ = {};
  return count;
}

void StreamWriter::close(std::chrono::milliseconds longest) {
  if (descriptor_.channel) descriptor_.channel->end();
  if (is_socket_) ::shutdown(descriptor_.get(), SHUT_WR);
  if (descriptor_.channel) await_acknowledgement(descriptor_.get(), longest);
  descriptor_ = ConnectedSocket();
}

}  // namespace hc::internal
