// SPDX-License-Identifier: Apache-2.0
// Who answers at a shared memory link's socket with what it should not: one clear error, and those
// who keep the rules continue.
#include <fcntl.h>
#include <sys/ioctl.h>
#include <sys/syscall.h>

#include <cstdio>
#include <deque>

#include "checked_message.h"
#include "hostile_peer.h"

#include <hc/testing/must.h>

namespace hc::testing {
namespace {

using internal::kLeastMemory;

/// What is handed over, and what is said of it.
struct Case {
  std::string name;
  std::function<std::vector<Descriptor>(std::uint64_t bytes)> make;
  std::string error;
};

std::vector<Descriptor> one(Descriptor descriptor) {
  std::vector<Descriptor> all;
  all.push_back(std::move(descriptor));
  return all;
}
Descriptor open_file(const char* path, int flags) {
  return Descriptor(::open(path, flags | O_CLOEXEC));
}
Descriptor reopen(const Descriptor& descriptor, int flags) {
  return open_file(("/proc/self/fd/" + std::to_string(descriptor.get())).c_str(), flags);
}

const std::vector<Case>& memories() {
  static const std::vector<Case> kMemories = {
      {"none", [](auto) { return std::vector<Descriptor>(); }, " descriptors were handed over"},
      {"three",
       [](auto bytes) {
         std::vector<Descriptor> all(3);
         for (auto& each : all) each = make_memfd(bytes, kSealed);
         return all;
       },
       " descriptors were handed over"},
      {"many",
       [](auto bytes) {
         std::vector<Descriptor> all(12);
         for (auto& each : all) each = make_memfd(bytes, kSealed);
         return all;
       },
       " descriptors were handed over"},
      {"file",
       [](auto bytes) {
         Descriptor file(::open("/tmp", O_TMPFILE | O_RDWR | O_CLOEXEC, 0600));
         EXPECT_EQ(::ftruncate(file.get(), static_cast<off_t>(bytes)), 0);
         return one(std::move(file));
       },
       "the received shared memory "},
      {"unsealed", [](auto bytes) { return one(make_memfd(bytes, 0)); },
       "is not sealed against resizing"},
      {"growing", [](auto bytes) { return one(make_memfd(bytes, F_SEAL_SHRINK | F_SEAL_SEAL)); },
       "is not sealed against resizing"},
      {"shrinking",
       [](auto bytes) {
         auto memory = make_memfd(bytes, F_SEAL_GROW);
         EXPECT_EQ(::ftruncate(memory.get(), 0), 0);
         return one(std::move(memory));
       },
       "is not sealed against resizing"},
      {"short", [](auto bytes) { return one(make_memfd(bytes - kPageBytes, kSealed)); },
       " bytes, not "},
      {"empty", [](auto) { return one(make_memfd(0, kSealed)); }, "has 0 bytes, not "},
      {"long", [](auto bytes) { return one(make_memfd(bytes + 1, kSealed)); }, " bytes, not "},
      {"zero", [](auto) { return one(open_file("/dev/zero", O_RDWR)); }, "cannot be sealed"},
      {"folder", [](auto) { return one(open_file("/", O_RDONLY)); }, "cannot be sealed"},
      {"pipe", [](auto) { return one(make_pipe()); }, "cannot be sealed"},
      {"socket", [](auto) { return one(Descriptor(::socket(AF_UNIX, SOCK_STREAM, 0))); },
       "cannot be sealed"},
      {"path", [](auto bytes) { return one(reopen(make_memfd(bytes, kSealed), O_PATH)); },
       "cannot be sealed"},
      {"unreadable", [](auto bytes) { return one(reopen(make_memfd(bytes, kSealed), O_WRONLY)); },
       "cannot be mapped"},
  };
  return kMemories;
}

std::vector<int> numbers_of(const std::vector<Descriptor>& descriptors) {
  std::vector<int> numbers;
  for (const auto& each : descriptors) numbers.push_back(each.get());
  return numbers;
}

struct Text {
  std::string text, error;
};

TEST(HostilePublisher, HandsOverWhatIsNoSealedMemory) {
  for (const auto& each : memories()) {
    auto name = fresh_name();
    FakePublisher publisher(name);
    auto memory = each.make(kLeastMemory);
    const auto source = refused(publisher.open(name, offer(kLeastMemory), numbers_of(memory)));
    EXPECT_EQ(source.code, Code::Malformed) << each.name;
    EXPECT_NE(source.detail.find(each.error), std::string::npos)
        << each.name << ": " << source.detail;
  }
}

TEST(HostilePublisher, MayHandOverMemoryThatCanOnlyBeRead) {
  auto name = fresh_name();
  FakePublisher publisher(name);
  auto memory = reopen(make_memfd(kLeastMemory, kSealed), O_RDONLY);
  EXPECT_TRUE(publisher.open(name, offer(kLeastMemory), {memory.get()}));
}

TEST(HostilePublisher, SaysWhatIsNoOffer) {
  const std::string stranger = "no end of a shared memory link",
                    none = "no offer: ", no_text = "a refusal that is no text";
  const auto whole = offer(kLeastMemory);
  const std::vector<Text> texts = {
      {"HTTP/1.1 400 Bad Request\r\n\r\n", stranger},
      {std::string(whole.size(), '\0'), stranger},
      {whole.substr(0, 8), stranger},
      {whole.substr(0, whole.size() - 1), stranger},
      {greeting([](auto& words) { words.magic[6] = '1'; }), stranger},
      {std::string(100'000, 'x'), stranger},
      {"\n", stranger},
      {refusal("\x1b[2J"), no_text},
      {refusal("\xff"), no_text},
      {refusal(std::string(128, 'x')), no_text},
      {offer(0), none},
      {offer(kLeastMemory - kPageBytes), none},
      {offer((std::uint64_t{1} << 40) + 1), none},
      {offer(std::numeric_limits<std::uint64_t>::max()), none},
      {refusal("it is Sunday"), "1 descriptors were handed over, not 0"},
  };
  for (const auto& each : texts) {
    auto name = fresh_name();
    FakePublisher publisher(name);
    auto memory = make_memfd(kLeastMemory, kSealed);
    const auto source = refused(publisher.open(name, each.text, {memory.get()}));
    EXPECT_NE(source.detail.find(each.error), std::string::npos)
        << each.text << ": " << source.detail;
    for (char letter : source.detail) EXPECT_GE(letter, ' ') << source.detail;
  }
}

TEST(HostilePublisher, Refuses) {
  auto name = fresh_name();
  FakePublisher publisher(name);
  EXPECT_EQ(refused(publisher.open(name, refusal("it is Sunday"), {})).text(),
            "Closed: the publisher refuses: it is Sunday");
}

TEST(HostilePublisher, GoesOrSaysNothing) {
  auto name = fresh_name();
  FakePublisher publisher(name);
  EXPECT_EQ(refused(publisher.open(name, "", {}, true)).text(),
            "Closed: the publisher closed during the handshake");
  auto silent = publisher.open(name, "", {});  // waits for as long as an answer may take
  ASSERT_FALSE(silent);
  EXPECT_EQ(silent.error().text(), "Closed: the publisher does not answer");
}

/// A publisher with a reader that keeps the rules, and what the publisher's log says, on the thread
/// that publishes alone.
class HostileReader : public ::testing::Test {
 protected:
  HostileReader() {
    LinkOptions options;
    options.log = [this, self = std::this_thread::get_id()](Level, std::string_view line) {
      EXPECT_EQ(std::this_thread::get_id(), self);
      lines_.emplace_back(line);
    };
    sink_ = std::move(*open_sink(*parse_uri(name_), options));
    source_ = std::move(*open_source(*parse_uri(name_)));
  }
  ~HostileReader() override { sink_.reset(); }

  std::string next_line() {
    while (lines_.empty()) expect_to_continue();
    auto line = lines_.front();
    lines_.pop_front();
    return line;
  }
  void expect_to_continue() {
    for (auto bytes : {24, 100'000}) {
      ASSERT_TRUE(sink_->send(make_checked(sink_.get(), 1, ++seq_, bytes)));
      Message message;
      auto got = receive(*source_, message);
      ASSERT_TRUE(got && *got);
      EXPECT_EQ(message.header.seq, seq_);
      EXPECT_TRUE(is_whole(message));
    }
  }
  void expect_refused(const std::string& text, const std::vector<Descriptor>& descriptors,
                      const std::string& error) {
    auto socket = connect_to_publisher(name_);
    hand_over(socket.get(), text, numbers_of(descriptors));
    auto line = next_line();
    EXPECT_TRUE(line.starts_with(name_ + ": refused a reader: ")) << line;
    EXPECT_NE(line.find(error), std::string::npos) << text << ": " << line;
    for (char letter : line) EXPECT_GE(letter, ' ') << line;
    auto answer = rest_of(socket.get());
    EXPECT_TRUE(answer.empty() || answer.starts_with("HCSHM/2\n")) << answer;
    expect_to_continue();
  }

  const std::string name_ = fresh_name();
  std::deque<std::string> lines_;
  std::unique_ptr<Sink> sink_;
  std::unique_ptr<Source> source_;
  std::int64_t seq_ = 0;
};

TEST_F(HostileReader, HandsOverWhatIsNoSealedPage) {
  for (const auto& each : memories()) {
    SCOPED_TRACE(each.name);
    auto all = each.make(kPageBytes);
    if (all.size() == 1) all.push_back(make_pipe());
    expect_refused(hello(), all, each.error);
  }
}

TEST_F(HostileReader, HandsOverWhatIsNoPipe) {
  for (const auto& each : memories()) {
    if (each.name == "pipe") continue;
    SCOPED_TRACE(each.name);
    auto all = each.make(kPageBytes);
    if (all.size() == 1) all.insert(all.begin(), make_memfd(kPageBytes, kSealed));
    expect_refused(hello(), all, all.size() == 2 ? "is no pipe" : " descriptors were handed over");
  }
}

TEST_F(HostileReader, SaysWhatIsNoHello) {
  const std::string stranger = "no end of a shared memory link";
  const std::vector<Text> texts = {
      {"GET / HTTP/1.1\r\n\r\n", stranger},
      {hello().substr(1), stranger},
      {hello().substr(0, 8), stranger},
      {std::string(5000, 'x'), stranger},
      {refusal("it is Sunday"), "2 descriptors were handed over, not 0"},
      {refusal("\x1b[2J"), "a refusal that is no text"},
  };
  for (const auto& each : texts) {
    auto both = one(make_memfd(kPageBytes, kSealed));
    both.push_back(make_pipe());
    expect_refused(each.text, both, each.error);
  }
}

TEST_F(HostileReader, SaysNothing) {
  std::vector<Descriptor> silent(3 * internal::kMostReaders);
  for (auto& each : silent) each = connect_to_publisher(name_);
  auto late = open_source(*parse_uri(name_));
  ASSERT_TRUE(late) << late.error().text();
  expect_to_continue();
  Message message;
  EXPECT_TRUE(*receive(**late, message));
}

TEST_F(HostileReader, GoesAtOnce) {
  for (int i = 0; i < 200; ++i) {
    auto socket = connect_to_publisher(name_);
    auto page = make_memfd(kPageBytes, kSealed);
    auto pipe = make_pipe();
    if (i % 3 > 0) hand_over(socket.get(), hello(), {page.get(), pipe.get()});
    if (i % 3 > 1) ::shutdown(socket.get(), SHUT_WR);
  }
  expect_to_continue();
}

/// One whose answer cannot be sent is let go of, and then not touched: AddressSanitizer would see
/// it.
TEST_F(HostileReader, TakesNoAnswer) {
  auto socket = connect_to_publisher(name_);
  auto page = make_memfd(kPageBytes, kSealed);
  auto pipe = make_pipe();
  ASSERT_EQ(::shutdown(socket.get(), SHUT_RD), 0);
  hand_over(socket.get(), hello(), {page.get(), pipe.get()});
  pollfd polled{socket.get(), 0, 0};  // until the publisher closes
  ASSERT_EQ(::poll(&polled, 1, -1), 1);
  EXPECT_EQ(polled.revents & POLLHUP, POLLHUP);
  expect_to_continue();
}

/// Neither a pipe that is full nor one whose open file is set to wait keeps the publisher.
TEST_F(HostileReader, NeverTakesWhatWakesIt) {
  auto socket = connect_to_publisher(name_);
  Writable page(kPageBytes);
  page.page().armed.store(1);
  std::array<int, 2> ends{};
  ASSERT_EQ(::pipe2(ends.data(), O_CLOEXEC), 0);  // writing to it waits
  Descriptor reader(ends[0]), writer(ends[1]);
  ::fcntl(reader.get(), F_SETPIPE_SZ, 4096);
  hand_over(socket.get(), hello(1), {page.descriptor(), writer.get()});
  pollfd polled{socket.get(), POLLIN, 0};
  ASSERT_EQ(::poll(&polled, 1, -1), 1);
  for (std::uint32_t i = 0; i < 5000; ++i) {  // more than the pipe takes
    page.page().armed.store(2 * i + 3);
    expect_to_continue();
  }
  int unread = 0;
  ASSERT_EQ(::ioctl(reader.get(), FIONREAD, &unread), 0);
  EXPECT_EQ(unread, 4096);
}

TEST_F(HostileReader, ClosesThePipeThatWakesIt) {
  auto socket = connect_to_publisher(name_);
  Writable page(kPageBytes);
  auto pipe = make_pipe();
  hand_over(socket.get(), hello(1), {page.descriptor(), pipe.get()});
  pollfd polled{socket.get(), POLLIN, 0};
  ASSERT_EQ(::poll(&polled, 1, -1), 1);
  pipe.reset();
  for (std::uint32_t i = 1; i < 10; ++i) {
    page.page().armed.store(i);
    expect_to_continue();  // without a signal
  }
}

TEST_F(HostileReader, IsOfAnotherUser) {
  if (::geteuid() != 0) GTEST_SKIP() << "who is not root cannot be somebody else";
  constexpr unsigned kNobody = 65534;
  Result<std::unique_ptr<Source>> refused = Error{};
  // A user is a thread's own affair, but for what libc makes of it.
  std::thread([&] {
    ASSERT_EQ(::syscall(SYS_setresuid, -1, kNobody, -1), 0);
    refused = open_source(*parse_uri(name_));
  }).join();
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().text(), "Closed: the publisher refuses: another user");
  EXPECT_EQ(next_line(), name_ + ": refused a reader of another user (uid 65534)");
  expect_to_continue();
}

TEST_F(HostileReader, CannotBeTooMany) {
  std::vector<std::unique_ptr<Source>> sources;
  while (sources.size() + 1 < internal::kMostReaders)
    sources.push_back(std::move(*open_source(*parse_uri(name_ + "?keep=latest"))));
  EXPECT_EQ(refused(open_source(*parse_uri(name_))).text(),
            "Closed: the publisher refuses: it has 64 readers already");
  EXPECT_EQ(next_line(), name_ + ": refused a reader: it has 64 readers already");
  expect_to_continue();
}

}  // namespace
}  // namespace hc::testing
