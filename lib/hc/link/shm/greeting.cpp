// SPDX-License-Identifier: Apache-2.0
#include <hc/link/shm/greeting.h>

#include <sys/socket.h>
#include <sys/un.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <optional>

#include <hc/link/shm/crash_point.h>
#include <hc/link/stream/source.h>
#include <hc/os/socket.h>

namespace hc::internal {
namespace {

constexpr std::string_view kMeetingPlace = "@hypercolumn-shm-";
constexpr std::string_view kGreeting = "MTP-SHM/1 ";
constexpr std::size_t kMostBytes = 256;      // of a greeting
constexpr std::size_t kMostDescriptors = 4;  // more than are wanted, so that none is overlooked
constexpr std::uint64_t kMostMemory = std::uint64_t{1} << 40;  // [byte]

struct Greeting {
  std::string text;  // without the words that every greeting begins with, nor its line feed
  Descriptor memory;
};

Error malformed(std::string what) {
  return {Code::Malformed, std::move(what)};
}

/// Sends one greeting, whole or not at all.
Status send_greeting(int socket, std::string_view text, int descriptor) {
  std::string line(kGreeting);
  line.append(text).append("\n");
  iovec part{line.data(), line.size()};
  alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(int))> control{};
  msghdr header{};
  header.msg_iov = &part;
  header.msg_iovlen = 1;
  if (descriptor >= 0) {
    header.msg_control = control.data();
    header.msg_controllen = control.size();
    cmsghdr* passed = CMSG_FIRSTHDR(&header);
    passed->cmsg_level = SOL_SOCKET;
    passed->cmsg_type = SCM_RIGHTS;
    passed->cmsg_len = CMSG_LEN(sizeof(int));
    std::memcpy(CMSG_DATA(passed), &descriptor, sizeof descriptor);
  }
  auto sent = system_call("sendmsg", "shm",
                          [&] { return ::sendmsg(socket, &header, MSG_NOSIGNAL | MSG_DONTWAIT); });
  if (!sent) return sent.error();
  return {};
}

/// Takes one greeting, which comes in one piece; never waits.
Result<Greeting> take_greeting(int socket) {
  std::array<char, kMostBytes> bytes;
  iovec part{bytes.data(), bytes.size()};
  alignas(cmsghdr) std::array<char, CMSG_SPACE(kMostDescriptors * sizeof(int))> control{};
  msghdr header{};
  header.msg_iov = &part;
  header.msg_iovlen = 1;
  header.msg_control = control.data();
  header.msg_controllen = control.size();
  auto size = system_call("recvmsg", "shm", [&] {
    return ::recvmsg(socket, &header, MSG_CMSG_CLOEXEC | MSG_DONTWAIT);
  });
  if (!size) return size.error();
  std::array<Descriptor, kMostDescriptors> descriptors;  // whatever comes is closed again
  std::size_t count = 0;
  for (cmsghdr* each = CMSG_FIRSTHDR(&header); each != nullptr; each = CMSG_NXTHDR(&header, each)) {
    if (each->cmsg_level != SOL_SOCKET || each->cmsg_type != SCM_RIGHTS) continue;
    for (std::size_t at = CMSG_LEN(0); at + sizeof(int) <= each->cmsg_len; at += sizeof(int)) {
      int number = -1;
      std::memcpy(&number, reinterpret_cast<const char*>(each) + at, sizeof number);
      descriptors[count++] = Descriptor(number);
    }
  }
  std::string_view text(bytes.data(), static_cast<std::size_t>(*size));
  if (text.empty()) return Error{Code::Closed, "the other side has gone"};
  // Its words are shown to people, so they are printable.
  auto end = std::find_if(text.begin(), text.end(), [](char c) { return c < ' ' || c > '~'; });
  if (!text.starts_with(kGreeting) || end != text.end() - 1 || *end != '\n')
    return malformed("what answers is no end of a shared memory link");
  if (count > 1 || (header.msg_flags & MSG_CTRUNC) != 0)
    return malformed("more was handed over than one memory");
  text = text.substr(kGreeting.size(), text.size() - kGreeting.size() - 1);
  return Greeting{std::string(text), std::move(descriptors[0])};
}

/// The value of `KEY=` in a greeting's words; nothing where it is not there.
std::optional<std::string_view> word(std::string_view text, std::string_view key) {
  while (!text.empty()) {
    auto end = std::min(text.find(' '), text.size());
    auto entry = text.substr(0, end);
    if (entry.starts_with(key) && entry.substr(key.size()).starts_with('='))
      return entry.substr(key.size() + 1);
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return std::nullopt;
}

std::optional<std::uint64_t> number(std::optional<std::string_view> text) {
  std::uint64_t value = 0;
  if (!text || text->empty()) return std::nullopt;
  auto [stop, status] = std::from_chars(text->data(), text->data() + text->size(), value);
  if (status != std::errc() || stop != text->data() + text->size()) return std::nullopt;
  return value;
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

Result<std::uint64_t> parse_keep(std::string_view text) {
  if (text == "all") return std::uint64_t{0};
  if (text == "latest") return std::uint64_t{1};
  auto count = number(text);
  if (!count || *count == 0)
    return Error{Code::Invalid, R"(keep is "all", "latest" or a number from 1 on, not ")" +
                                    std::string(text) + "\""};
  return *count;
}

Status send_hello(int socket, std::string_view keep, const SharedMemory& page) {
  auto page_descriptor = page.read_only();
  if (!page_descriptor) return page_descriptor.error();
  std::string words = keep.empty() ? "" : "keep=" + std::string(keep) + " ";
  words += can_order_everywhere() ? "orders=1" : "orders=0";
  auto sent = send_greeting(socket, words, page_descriptor->get());
  // Who has refused us before we said anything has told why.
  if (!sent && sent.error().code != Code::Closed) return sent;
  HC_CRASH_POINT("reader greeted");
  return {};
}

Result<std::optional<Offer>> take_offer(int socket) {
  pollfd polled{socket, POLLIN, 0};
  if (::poll(&polled, 1, 0) == 0) return std::optional<Offer>();
  auto greeting = take_greeting(socket);
  if (!greeting && greeting.error().code == Code::Closed)
    return Error{Code::Closed, "the publisher has gone before it answered"};
  if (!greeting) return greeting.error();
  constexpr std::string_view kRefused = "refused: ";
  if (greeting->text.starts_with(kRefused))
    return Error{Code::Closed, "the publisher refuses: " + greeting->text.substr(kRefused.size())};
  auto bytes = number(word(greeting->text, "bytes")), begin = number(word(greeting->text, "begin"));
  auto kept = number(word(greeting->text, "keep"));
  if (!bytes || !begin || !kept || *bytes < kLeastMemory || *bytes > kMostMemory)
    return malformed("no offer: \"" + greeting->text + "\"");
  auto memory = SharedMemory::map(std::move(greeting->memory), *bytes);
  if (!memory) return malformed(memory.error().detail);
  HC_CRASH_POINT("reader has memory");
  return std::optional<Offer>(Offer{*begin, *kept, std::move(*memory)});
}

Result<Offer> await_offer(int socket, int stop) {
  auto answered = wait_for(socket, POLLIN, stop, std::chrono::steady_clock::now() + kAnswerTime);
  if (!answered) return answered.error();
  auto offer = *answered ? take_offer(socket) : Result<std::optional<Offer>>(std::nullopt);
  if (!offer) return offer.error();
  if (!offer->has_value()) return Error{Code::Closed, "the publisher does not answer"};
  return std::move(**offer);
}

Result<Hello> take_hello(int socket, std::uint64_t default_value) {
  auto greeting = take_greeting(socket);
  if (!greeting) return greeting.error();
  Hello hello;
  hello.keep = default_value;
  if (auto text = word(greeting->text, "keep")) {
    auto keep = parse_keep(*text);
    if (!keep) return malformed(keep.error().detail);
    if (*keep > 0) hello.keep = *keep;  // none can have a publisher wait that does not
  }
  hello.orders = word(greeting->text, "orders") == "1";
  auto page = SharedMemory::map(std::move(greeting->memory), kPageBytes);
  if (!page) return malformed(page.error().detail);
  hello.page = std::move(*page);
  return hello;
}

Status answer(int socket, const Offer& offer, std::uint64_t bytes, int read_only_memory) {
  return send_greeting(socket,
                       "bytes=" + std::to_string(bytes) + " begin=" + std::to_string(offer.begin) +
                           " keep=" + std::to_string(offer.keep),
                       read_only_memory);
}

void refuse(int socket, std::string_view why) {
  static_cast<void>(send_greeting(socket, "refused: " + std::string(why.substr(0, 128)), -1));
}

}  // namespace hc::internal
