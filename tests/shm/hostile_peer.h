// SPDX-License-Identifier: Apache-2.0
#pragma once
// Ends of a shared memory link that do not keep the rules: whatever text and descriptors a test
// wants are handed over, and the words of the memory are the test's own to write.

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/socket.h>

#include <array>
#include <cstdlib>
#include <cstring>
#include <string>
#include <thread>
#include <vector>

#include <hc/link/link.h>
#include <hc/link/shm/greeting.h>
#include <hc/link/shm/layout.h>
#include <hc/link/stream/ends.h>
#include <hc/os/descriptor.h>

namespace hc::testing {

inline std::string fresh_name() {
  static int count = 0;
  return "shm:hostile-" + std::to_string(::getpid()) + "-" + std::to_string(count++);
}

constexpr int kSealed = F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_SEAL;

inline Descriptor make_memfd(std::uint64_t bytes, int seals) {
  Descriptor memory(::memfd_create("hostile", MFD_CLOEXEC | MFD_ALLOW_SEALING));
  EXPECT_EQ(::ftruncate(memory.get(), static_cast<off_t>(bytes)), 0);
  EXPECT_TRUE(seals == 0 || ::fcntl(memory.get(), F_ADD_SEALS, seals) == 0);
  return memory;
}

/// A view of sealed memory that can be written.
class Writable {
 public:
  explicit Writable(std::uint64_t bytes) : descriptor_(make_memfd(bytes, kSealed)), bytes_(bytes) {
    data_ = ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, descriptor_.get(), 0);
    EXPECT_NE(data_, MAP_FAILED);
  }
  Writable(const Writable&) = delete;
  Writable& operator=(const Writable&) = delete;
  ~Writable() { ::munmap(data_, bytes_); }

  [[nodiscard]] int descriptor() const { return descriptor_.get(); }
  [[nodiscard]] std::byte* data() const { return static_cast<std::byte*>(data_); }
  [[nodiscard]] internal::Head& head() const { return *static_cast<internal::Head*>(data_); }
  [[nodiscard]] internal::ReaderPage& page() const {
    return *static_cast<internal::ReaderPage*>(data_);
  }
  [[nodiscard]] internal::Cell& cell(std::uint64_t position) const {
    return reinterpret_cast<internal::Cell*>(data() +
                                             internal::kRingBegin)[position % internal::kCells];
  }

 private:
  Descriptor descriptor_;
  std::uint64_t bytes_;
  void* data_ = nullptr;
};

inline Descriptor make_pipe() {
  std::array<int, 2> ends{};
  EXPECT_EQ(::pipe2(ends.data(), O_CLOEXEC), 0);
  Descriptor other(ends[1]);
  return Descriptor(ends[0]);
}

inline void hand_over(int socket, std::string text, const std::vector<int>& descriptors) {
  iovec part{text.data(), text.size()};
  alignas(cmsghdr) std::array<char, CMSG_SPACE(16 * sizeof(int))> control{};
  msghdr header{};
  header.msg_iov = &part;
  header.msg_iovlen = 1;
  if (!descriptors.empty()) {
    auto bytes = descriptors.size() * sizeof(int);
    header.msg_control = control.data();
    header.msg_controllen = CMSG_SPACE(bytes);
    cmsghdr* passed = CMSG_FIRSTHDR(&header);
    passed->cmsg_level = SOL_SOCKET;
    passed->cmsg_type = SCM_RIGHTS;
    passed->cmsg_len = CMSG_LEN(bytes);
    std::memcpy(CMSG_DATA(passed), descriptors.data(), bytes);
  }
  ::sendmsg(socket, &header, MSG_NOSIGNAL);
}

/// What comes until the other side ends the connection.
inline std::string rest_of(int socket) {
  std::string text;
  std::array<char, 512> bytes;
  for (pollfd polled{socket, POLLIN, 0}; ::poll(&polled, 1, -1) > 0;) {
    auto size = ::recv(socket, bytes.data(), bytes.size(), 0);
    if (size <= 0) break;
    text.append(bytes.data(), static_cast<std::size_t>(size));
  }
  return text;
}

/// Listens where a publisher of the name would, and answers readers.
class FakePublisher {
 public:
  explicit FakePublisher(const std::string& name)
      : listening_(std::move(*internal::listen_unix(internal::meeting_place(*parse_uri(name))))) {}

  /// Lets one reader in and says `text` to it; its page is to be had afterwards.
  void answer(const std::string& text, const std::vector<int>& descriptors) {
    pollfd polled{listening_.descriptor.get(), POLLIN, 0};
    ASSERT_EQ(::poll(&polled, 1, -1), 1);
    peer_ = Descriptor(::accept4(listening_.descriptor.get(), nullptr, nullptr, SOCK_CLOEXEC));
    polled.fd = peer_.get();
    ASSERT_EQ(::poll(&polled, 1, -1), 1);
    if (auto hello = internal::take_hello(peer_.get(), 0)) page_ = std::move(hello->page);
    hand_over(peer_.get(), text, descriptors);
  }
  /// Opens a source on this publisher, which answers so.
  Result<std::unique_ptr<Source>> open(const std::string& uri, const std::string& text,
                                       const std::vector<int>& descriptors, bool leave = false) {
    std::thread publisher([&] {
      answer(text, descriptors);
      if (leave) leave_reader();
    });
    auto source = open_source(*parse_uri(uri));
    publisher.join();
    return source;
  }
  void leave_reader() { peer_.reset(); }

  [[nodiscard]] const internal::ReaderPage& page() const {
    return *reinterpret_cast<const internal::ReaderPage*>(page_.data());
  }

 private:
  ListeningSocket listening_;
  Descriptor peer_;
  SharedMemory page_;
};

/// The bytes of a greeting, in which `change` has changed what it wants.
template <typename Change>
std::string greeting(const Change& change) {
  internal::Greeting greeting{};
  std::memcpy(greeting.magic.data(), "HCSHM/3\n", greeting.magic.size());
  change(greeting);
  return {reinterpret_cast<const char*>(&greeting), sizeof greeting};
}

inline std::string hello(std::uint64_t keep = internal::kPublishersKeep) {
  return greeting([&](auto& words) { words.keep = keep; });
}

inline std::string offer(std::uint64_t bytes, std::uint64_t begin = 0, std::uint64_t keep = 0) {
  return greeting([&](auto& words) {
    words.bytes = bytes;
    words.begin = begin;
    words.keep = keep;
  });
}

inline std::string refusal(std::string_view why) {
  return greeting([&](auto& words) { why.copy(words.refusal.data(), words.refusal.size()); });
}

/// A small generator that keeps up with what it is to disturb.
class Dice {
 public:
  std::uint64_t operator()() {
    state_ ^= state_ << 13;
    state_ ^= state_ >> 7;
    return state_ ^= state_ << 17;
  }

 private:
  std::uint64_t state_ = 0x1234'5678'9abc'def1;
};

/// How often hostile words are tried.
inline std::int64_t rounds(std::int64_t default_value) {
  const char* text = std::getenv("HC_SHM_ROUNDS");
  return text == nullptr ? default_value : std::atoll(text);
}

/// A connection to the publisher of the name.
inline Descriptor connect_to_publisher(const std::string& name) {
  auto place = internal::meeting_place(*parse_uri(name));
  place.options.emplace_back("wait", "20");  // many at once do not fit into its backlog
  auto socket = internal::connect_now(*internal::unix_peer(place), place, {});
  EXPECT_TRUE(socket) << socket.error().text();
  return std::move(socket->descriptor);
}

}  // namespace hc::testing
