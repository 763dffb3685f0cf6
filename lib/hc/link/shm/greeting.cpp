// SPDX-License-Identifier: Apache-2.0
#include <hc/link/shm/greeting.h>

#include <fcntl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <span>

#include <hc/link/shm/crash_point.h>
#include <hc/link/stream/source.h>
#include <hc/os/socket.h>

namespace hc::internal {
namespace {

constexpr std::string_view kMeetingPlace = "@hypercolumn-shm-";
/// Changed with every change of the layout or the handshake.
constexpr std::array<char, 8> kMagic = {'H', 'C', 'S', 'H', 'M', '/', '3', '\n'};
constexpr std::size_t kMostDescriptors = 4;  // more than expected, so that extra ones are noticed
constexpr std::uint64_t kMostMemory = std::uint64_t{1} << 40;  // [byte]

struct Received {
  Greeting greeting{};
  std::array<Descriptor, kMostDescriptors> descriptors;
};

Error malformed(std::string what) {
  return {Code::Malformed, std::move(what)};
}

/// Sends a greeting, completely or not at all.
Status send_greeting(int socket, Greeting greeting, std::span<const int> descriptors) {
  greeting.magic = kMagic;
  iovec part{&greeting, sizeof greeting};
  alignas(cmsghdr) std::array<char, CMSG_SPACE(kMostDescriptors * sizeof(int))> control{};
  msghdr header{};
  header.msg_iov = &part;
  header.msg_iovlen = 1;
  if (!descriptors.empty()) {
    header.msg_control = control.data();
    header.msg_controllen = CMSG_SPACE(descriptors.size_bytes());
    cmsghdr* passed = CMSG_FIRSTHDR(&header);
    passed->cmsg_level = SOL_SOCKET;
    passed->cmsg_type = SCM_RIGHTS;
    passed->cmsg_len = CMSG_LEN(descriptors.size_bytes());
    std::memcpy(CMSG_DATA(passed), descriptors.data(), descriptors.size_bytes());
  }
  HC_TRY(system_call("sendmsg", "shm",
                     [&] { return ::sendmsg(socket, &header, MSG_NOSIGNAL | MSG_DONTWAIT); }));
  return {};
}

/// Receives a greeting in one piece, with `wanted` descriptors or, if it refuses, none; never
/// waits.
Result<Received> take_greeting(int socket, std::size_t wanted) {
  Received received;
  auto& [greeting, descriptors] = received;
  iovec part{&greeting, sizeof greeting};
  alignas(cmsghdr) std::array<char, CMSG_SPACE(kMostDescriptors * sizeof(int))> control{};
  msghdr header{};
  header.msg_iov = &part;
  header.msg_iovlen = 1;
  header.msg_control = control.data();
  header.msg_controllen = control.size();
  auto size = HC_TRY(system_call("recvmsg", "shm", [&] {
    return ::recvmsg(socket, &header, MSG_CMSG_CLOEXEC | MSG_DONTWAIT);
  }));
  std::size_t count = 0;
  for (cmsghdr* each = CMSG_FIRSTHDR(&header); each != nullptr; each = CMSG_NXTHDR(&header, each)) {
    if (each->cmsg_level != SOL_SOCKET || each->cmsg_type != SCM_RIGHTS) continue;
    for (std::size_t at = CMSG_LEN(0); at + sizeof(int) <= each->cmsg_len; at += sizeof(int)) {
      int number = -1;
      std::memcpy(&number, reinterpret_cast<const char*>(each) + at, sizeof number);
      descriptors[count++] = Descriptor(number);
    }
  }
  if (size == 0) return Error{Code::Closed, "the other side disconnected"};
  if (static_cast<std::size_t>(size) != sizeof greeting || greeting.magic != kMagic)
    return malformed("the peer is not a shared memory link of this version");
  // The text is shown to the user, so it must be printable.
  auto end = std::find(greeting.refusal.begin(), greeting.refusal.end(), '\0');
  if (end == greeting.refusal.end() ||
      !std::all_of(greeting.refusal.begin(), end, [](char c) { return c >= ' ' && c <= '~'; }))
    return malformed("the refusal is not printable text");
  if (end != greeting.refusal.begin()) wanted = 0;
  if (count != wanted || (header.msg_flags & MSG_CTRUNC) != 0)
    return malformed("received " + std::to_string(count) + " descriptors, not " +
                     std::to_string(wanted));
  return received;
}

/// Opens the received pipe again for writing, since the reader can make the received descriptor
/// blocking; and for reading, so that a write raises no signal after the reader has left.
Result<Descriptor> open_pipe(const Descriptor& pipe) {
  struct stat status {};
  if (::fstat(pipe.get(), &status) != 0 || !S_ISFIFO(status.st_mode))
    return malformed("the received descriptor is not a pipe");
  const std::string path = "/proc/self/fd/" + std::to_string(pipe.get());
  Descriptor own(::open(path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC));
  if (own.get() < 0) return malformed("the received pipe cannot be opened");
  return own;
}

}  // namespace

Uri meeting_place(const Uri& uri) {
  return {"unix", std::string(kMeetingPlace) + uri.rest, {}};
}

Status check_name(const Uri& uri) {
  constexpr std::size_t kMost = sizeof sockaddr_un::sun_path - 1 - kMeetingPlace.size();
  if (!uri.rest.empty() && uri.rest.size() <= kMost) return {};
  return Error{Code::Invalid, "a name of shared memory has 1 to " + std::to_string(kMost) +
                                  " bytes, not " + std::to_string(uri.rest.size())};
}

Status send_hello(int socket, std::uint64_t keep, const SharedMemory& page, int wakes) {
  auto page_descriptor = HC_TRY(page.read_only());
  Greeting greeting{};
  greeting.keep = keep;
  greeting.orders = can_order_everywhere() ? 1 : 0;
  auto sent = send_greeting(socket, greeting, std::array{page_descriptor.get(), wakes});
  // If the publisher has already refused, its reason can still be read.
  if (!sent && sent.error().code != Code::Closed) return sent;
  HC_CRASH_POINT("reader greeted");
  return {};
}

Result<std::optional<Offer>> take_offer(int socket) {
  pollfd polled{socket, POLLIN, 0};
  if (::poll(&polled, 1, 0) == 0) return std::optional<Offer>();
  auto received = take_greeting(socket, 1);
  if (!received && received.error().code == Code::Closed)
    return Error{Code::Closed, "the publisher closed during the handshake"};
  if (!received) return received.error();
  auto& [greeting, descriptors] = *received;
  if (greeting.refusal[0] != '\0')
    return Error{Code::Closed, std::string("the publisher refuses: ") + greeting.refusal.data()};
  if (greeting.bytes < kLeastMemory || greeting.bytes > kMostMemory)
    return malformed("invalid memory size: " + std::to_string(greeting.bytes) + " bytes");
  auto memory = SharedMemory::map(std::move(descriptors[0]), greeting.bytes);
  if (!memory) return malformed(memory.error().detail);
  HC_CRASH_POINT("reader has memory");
  return std::optional<Offer>(Offer{greeting.begin, greeting.keep, std::move(*memory)});
}

Result<Offer> await_offer(int socket, int stop) {
  HC_TRY(wait_for(socket, POLLIN, stop, std::chrono::steady_clock::now() + kAnswerTime));
  auto offer = HC_TRY(take_offer(socket));
  if (!offer) return Error{Code::Closed, "the publisher does not answer"};
  return std::move(*offer);
}

Result<Hello> take_hello(int socket, std::uint64_t keep) {
  auto received = HC_TRY(take_greeting(socket, 2));
  auto& [greeting, descriptors] = received;
  if (greeting.refusal[0] != '\0') return malformed("a reader cannot refuse");
  Hello hello;
  hello.keep = keep;
  // A publisher that does not wait for readers waits for none.
  if (greeting.keep > 0 && greeting.keep != kPublishersKeep) hello.keep = greeting.keep;
  hello.orders = greeting.orders == 1;
  auto page = SharedMemory::map(std::move(descriptors[0]), kPageBytes);
  if (!page) return malformed(page.error().detail);
  hello.page = std::move(*page);
  hello.wakes = HC_TRY(open_pipe(descriptors[1]));
  return hello;
}

Status answer(int socket, const Offer& offer, std::uint64_t bytes, int read_only_memory) {
  Greeting greeting{};
  greeting.keep = offer.keep;
  greeting.begin = offer.begin;
  greeting.bytes = bytes;
  return send_greeting(socket, greeting, std::array{read_only_memory});
}

void refuse(int socket, std::string_view why) {
  Greeting greeting{};
  why.copy(greeting.refusal.data(), greeting.refusal.size() - 1);
  static_cast<void>(send_greeting(socket, greeting, {}));
}

}  // namespace hc::internal
