// SPDX-License-Identifier: Apache-2.0
#include <hc/link/stream_link.h>

#include <fcntl.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/uio.h>

#include <algorithm>
#include <array>

namespace hc::internal {
namespace {

constexpr int kPipeBytes = 1 << 20;

bool would_wait(int number) {
  return number == EAGAIN || number == EWOULDBLOCK;
}

}  // namespace

Result<Got> StreamSource::take(Message& message) {
  while (true) {
    auto got = reader_.next(message);
    if (!got) return got.error();
    if (*got) return Got::Message;
    auto space = reader_.space();
    ssize_t size = is_socket_ ? ::recv(descriptor_.get(), space.data(), space.size(), MSG_DONTWAIT)
                              : ::read(descriptor_.get(), space.data(), space.size());
    if (size < 0 && errno == ENOTSOCK && is_socket_) {
      is_socket_ = false;
      continue;
    }
    if (size > 0) {
      reader_.commit(static_cast<std::size_t>(size));
      continue;
    }
    if (size < 0 && errno == EINTR) continue;
    if (size < 0 && would_wait(errno)) return Got::Nothing;
    // A peer that was killed with our bytes unread resets the connection: the end of what it said.
    if (size < 0 && errno != ECONNRESET) return system_error("read", "");
    if (size == 0 && awaits_writer()) return Got::Nothing;
    auto end = reader_.finish();
    if (!end) return end.error();
    return Got::End;
  }
}

bool StreamSource::awaits_writer() const {
  // Reading gives 0 before a writer has come as it does when all have left; only poll tells.
  pollfd polled{descriptor_.get(), POLLIN, 0};
  return may_await_writer_ && reader_.bytes() == 0 && ::poll(&polled, 1, 0) == 0;
}

Status StreamSource::resume() {
  // The reader begins again where the refused message began, and so must the file.
  auto begin = begin_ + static_cast<off_t>(reader_.message_begin());
  struct stat status {};
  if (::fstat(descriptor_.get(), &status) != 0 || !S_ISREG(status.st_mode)) return Source::resume();
  auto moved =
      system_call("lseek", "", [&] { return ::lseek(descriptor_.get(), begin, SEEK_SET); });
  if (!moved) return moved.error();
  reader_.resume();
  return {};
}

Status StreamSink::send(const Message& message) {
  return send_pieces(encoder_.encode(message));
}

Status StreamSink::wait_for_room(bool begun, std::optional<Deadline>& give_up) {
  while (true) {
    auto now = std::chrono::steady_clock::now();
    if (give_up && now >= *give_up)
      return Error{Code::Truncated,
                   "asked to stop, and the reader did not take the rest of a message"};
    auto ready = wait_for(descriptor_.get(), POLLOUT, give_up ? -1 : stop_,
                          std::min(now + kLookPeriod, give_up.value_or(Deadline::max())));
    if (ready && *ready) return {};
    if (!ready && (!begun || ready.error().code != Code::Stopped)) return ready.error();
    if (!ready) give_up = std::chrono::steady_clock::now() + kGrace;
    if (auto there = look_after_reader(); !there) return there;
  }
}

Status StreamSink::look_after_reader() const {
  if (is_socket_ && has_vanished(descriptor_.get()))
    return Error{Code::Closed, "the reader has vanished"};
  return {};
}

Status StreamSink::send_pieces(const Pieces& pieces) {
  std::array<iovec, std::tuple_size_v<Pieces>> parts{};
  std::size_t used = 0, left = 0;
  for (auto piece : pieces) {
    if (piece.empty()) continue;
    parts[used++] = {const_cast<std::byte*>(piece.data()), piece.size()};
    left += piece.size();
  }
  iovec* part = parts.data();
  if (auto there = look_after_reader(); !there) return there;
  const std::size_t whole = left;
  std::optional<Deadline> give_up;  // set when it is to stop inside the message
  traffic_.bytes += whole;
  while (left > 0) {
    msghdr header{};
    header.msg_iov = part;
    header.msg_iovlen = used - static_cast<std::size_t>(part - parts.data());
    ssize_t size = is_socket_
                       ? ::sendmsg(descriptor_.get(), &header, MSG_NOSIGNAL | MSG_DONTWAIT)
                       : ::writev(descriptor_.get(), part, static_cast<int>(header.msg_iovlen));
    if (size < 0) {
      if (errno == ENOTSOCK && is_socket_) {
        is_socket_ = false;
      } else if (would_wait(errno)) {
        if (auto room = wait_for_room(left < whole, give_up); !room) return room;
      } else if (errno != EINTR) {
        return system_error("write", "");
      }
      continue;
    }
    left -= static_cast<std::size_t>(size);
    for (auto rest = static_cast<std::size_t>(size); rest > 0;) {
      std::size_t taken = std::min(rest, part->iov_len);
      part->iov_base = static_cast<std::byte*>(part->iov_base) + taken;
      part->iov_len -= taken;
      rest -= taken;
      if (part->iov_len == 0) ++part;
    }
  }
  ++traffic_.messages;
  return {};
}

Status StreamSink::close() {
  if (is_socket_) ::shutdown(descriptor_.get(), SHUT_WR);
  descriptor_.reset();
  return {};
}

Result<Descriptor> reopen_without_waiting(int number, int access_mode) {
  struct stat status {};
  auto looked = system_call("fstat", "", [&] { return ::fstat(number, &status); });
  if (!looked) return looked.error();
  if (S_ISFIFO(status.st_mode) || S_ISCHR(status.st_mode)) {
    // A second open gets flags of its own; setting them on the first would set them for the shell
    // and for everybody else who shares it.
    std::string path = "/proc/self/fd/" + std::to_string(number);
    Descriptor own(::open(path.c_str(), access_mode | O_NONBLOCK | O_CLOEXEC | O_NOCTTY));
    if (own) {
      widen_pipe(own.get());
      return own;
    }
  }
  auto copy = system_call("dup", "", [&] { return ::fcntl(number, F_DUPFD_CLOEXEC, 0); });
  if (!copy) return copy.error();
  return Descriptor(*copy);
}

void widen_pipe(int descriptor) {
  ::fcntl(descriptor, F_SETPIPE_SZ, kPipeBytes);
}

bool has_vanished(int socket) {
  tcp_info info{};
  socklen_t size = sizeof info;
  if (::getsockopt(socket, IPPROTO_TCP, TCP_INFO, &info, &size) != 0) return false;
  // Without room at the reader's side nothing is sent again, but the reader is asked for room.
  auto asked = std::max(info.tcpi_retransmits, info.tcpi_probes);
  return asked >= 2 && std::chrono::milliseconds(info.tcpi_last_ack_recv) >= kVanishTime;
}

Status Pauses::next(int stop) {
  constexpr std::chrono::milliseconds kLongest{200};
  auto waited = wait_readable({}, stop, pause_);
  if (!waited) return waited.error();
  pause_ = std::min(2 * pause_, kLongest);
  return {};
}

Result<bool> wait_for(int descriptor, short events, int stop, std::optional<Deadline> deadline) {
  using std::chrono::milliseconds;
  std::array<pollfd, 2> polled = {{{descriptor, events, 0}, {stop, POLLIN, 0}}};
  auto ready = system_call("poll", "", [&] {
    milliseconds left(-1);
    if (deadline)
      left =
          std::max(milliseconds(0),
                   std::chrono::ceil<milliseconds>(*deadline - std::chrono::steady_clock::now()));
    return ::poll(polled.data(), polled.size(), static_cast<int>(left.count()));
  });
  if (!ready) return ready.error();
  if (polled[0].revents == 0 && polled[1].revents != 0)
    return Error{Code::Stopped, "asked to stop"};
  return *ready > 0;
}

}  // namespace hc::internal
