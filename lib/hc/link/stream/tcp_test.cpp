// SPDX-License-Identifier: Apache-2.0
#include <linux/filter.h>

#include <dlfcn.h>
#include <netdb.h>

#include <atomic>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>
#include <utility>

#include <hc/link/stream/ends.h>
#include <hc/os/peer_user.h>
#include <hc/os/wait_readable.h>
#include <hc/testing/socket_link.h>

namespace {

/// Whether the kernel chooses the other's port for a socket that connects, as it may.
std::atomic<bool> chooses_the_same_port{false};

/// Whether this process takes itself for another user's.
std::atomic<bool> is_another{false};

/// The address of the name "peer.test"; empty: it is unknown.
std::string known_address;
std::atomic<int> lookups{0};
std::mutex names;  // guards known_address

}  // namespace

extern "C" uid_t geteuid() noexcept {
  static auto* next = reinterpret_cast<decltype(&geteuid)>(::dlsym(RTLD_NEXT, "geteuid"));
  return next() + (is_another ? 1 : 0);
}

extern "C" int getaddrinfo(const char* host, const char* port, const addrinfo* hints,
                           addrinfo** found) {
  static auto* next = reinterpret_cast<decltype(&getaddrinfo)>(::dlsym(RTLD_NEXT, "getaddrinfo"));
  if (std::string_view(host) != "peer.test" || (hints->ai_flags & AI_NUMERICHOST) != 0)
    return next(host, port, hints, found);
  ++lookups;
  const std::lock_guard lock(names);
  return known_address.empty() ? EAI_AGAIN : next(known_address.c_str(), port, hints, found);
}

extern "C" int connect(int socket, const sockaddr* address, socklen_t size) {
  static auto* next = reinterpret_cast<decltype(&connect)>(::dlsym(RTLD_NEXT, "connect"));
  if (chooses_the_same_port) {
    EXPECT_EQ(::bind(socket, address, size), 0);
  }
  return next(socket, address, size);
}

namespace hc::testing {
namespace {

Descriptor connect(const std::string& place) {
  Descriptor socket(::socket(AF_INET, SOCK_STREAM, 0));
  sockaddr_in address = loopback(parse_host_port(place)->port);
  EXPECT_EQ(::connect(socket.get(), reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
  return socket;
}

std::string place_of(const Descriptor& listening) {
  sockaddr_in address{};
  socklen_t size = sizeof address;
  EXPECT_EQ(::getsockname(listening.get(), reinterpret_cast<sockaddr*>(&address), &size), 0);
  return "127.0.0.1:" + std::to_string(ntohs(address.sin_port));
}

const SocketScheme kTcp{
    "tcp", free_port, "tcp:", "tcp-listen:", connect, internal::tcp_peer, internal::listen_tcp};

INSTANTIATE_TEST_SUITE_P(Tcp, LinkConformance, ::testing::ValuesIn(both_ways(kTcp)));
INSTANTIATE_TEST_SUITE_P(Tcp, SocketLink, ::testing::Values(kTcp));
INSTANTIATE_TEST_SUITE_P(Tcp, AcceptingLink, ::testing::Values(kTcp));

TEST(Tcp, ListensOnLoopbackUnlessAskedOtherwise) {
  std::string port = free_port().substr(10);
  auto source = source_of("tcp-listen:" + port);
  sockaddr_in address{};
  socklen_t size = sizeof address;
  // The listening socket is the only one of this process.
  for (int number = 3; number < 64; ++number) {
    int listening = 0;
    socklen_t flag_size = sizeof listening;
    if (::getsockopt(number, SOL_SOCKET, SO_ACCEPTCONN, &listening, &flag_size) != 0 || !listening)
      continue;
    ASSERT_EQ(::getsockname(number, reinterpret_cast<sockaddr*>(&address), &size), 0);
    EXPECT_EQ(ntohl(address.sin_addr.s_addr), INADDR_LOOPBACK);
  }
  EXPECT_EQ(std::to_string(ntohs(address.sin_port)), port);
}

/// A name that stands for two ports of 127.0.0.1.
internal::Peer both(std::uint16_t first, std::uint16_t second) {
  return {{loopback_address(first), loopback_address(second)}, "both", {}};
}

TEST(Tcp, WaitingEndsThoughNobodyAnswers) {
  SilentPort silent;
  std::string place = "127.0.0.1:" + std::to_string(silent.port());
  EXPECT_EQ(open_source(*parse_uri("tcp:" + place + "?wait=1")).error().code, Code::Closed);
  EXPECT_EQ(open_source(*parse_uri("tcp:" + place)).error().code, Code::Closed);
  Stop stop;
  stop.raise();
  EXPECT_EQ(open_source(*parse_uri("tcp:" + place), stop.options()).error().code, Code::Stopped);
}

TEST(Tcp, AnAddressThatDoesNotAnswerLeavesTimeForTheNext) {
  SilentPort silent;
  std::string place = free_port();
  auto source = source_of("tcp-listen:" + place);
  auto peer = both(silent.port(), parse_host_port(place)->port);
  EXPECT_TRUE(internal::connect_now(peer, *parse_uri("tcp:both:1?wait=1"), {}));
}

TEST(Tcp, EveryAddressIsTriedAgain) {
  std::string place = free_port();
  auto peer = both(parse_host_port(place)->port, parse_host_port(free_port())->port);
  std::unique_ptr<Source> source;
  std::thread late([&] { source = source_of("tcp-listen:" + place); });
  EXPECT_TRUE(internal::connect_now(peer, *parse_uri("tcp:both:1?wait=60"), {}));
  late.join();
}

void rename_peer(const std::string& address) {
  const std::lock_guard lock(names);
  known_address = address;
}

TEST(Tcp, ANameThatIsUnknownAtFirstIsLookedUpAgain) {
  rename_peer("");
  const std::string port = free_port().substr(10);
  EXPECT_EQ(open_source(*parse_uri("tcp:peer.test:" + port)).error().code, Code::NotFound);
  for (const char* patience : {"?wait=60", "?reconnect=60"}) {
    rename_peer("");
    auto sink = sink_of("tcp-listen:127.0.0.2:" + port + "?readers=1");
    std::thread late([before = lookups.load()] {
      while (lookups < before + 3) std::this_thread::yield();
      rename_peer("127.0.0.2");
    });
    auto source = source_of("tcp:peer.test:" + port + patience);
    EXPECT_EQ(carry(*sink, *source, numbered(1, 10)).header.seq, 1) << patience;
    late.join();
  }
}

TEST(Tcp, APeerWithAnotherAddressIsFoundAgain) {
  const std::string port = free_port().substr(10);
  rename_peer("127.0.0.2");
  auto source = source_of("tcp:peer.test:" + port + "?reconnect=60");
  for (const std::string address : {"127.0.0.2", "127.0.0.3", "127.0.0.4"}) {
    rename_peer(address);
    auto sink = sink_of("tcp-listen:" + address + ":" + port + "?readers=1");
    EXPECT_EQ(carry(*sink, *source, numbered(1, 10)).header.seq, 1) << address;
  }
}

TEST(Tcp, AnAddressIsTriedWhileItsNameIsUnknown) {
  const std::string port = free_port().substr(10);
  rename_peer("127.0.0.2");
  auto source = source_of("tcp:peer.test:" + port + "?reconnect=60");
  for (int i = 0; i < 2; ++i) {
    auto sink = sink_of("tcp-listen:127.0.0.2:" + port + "?readers=1");
    EXPECT_EQ(carry(*sink, *source, numbered(1, 10)).header.seq, 1);
    rename_peer("");
  }
}

TEST(Tcp, AnUnknownNameIsLoggedAndGivenUp) {
  rename_peer("");
  Warnings warnings;
  auto source = open_source(*parse_uri("tcp:peer.test:7000?reconnect=3"), warnings.options());
  ASSERT_TRUE(source);
  Message message;
  auto got = (*source)->take(message);
  for (; got && *got == Got::Nothing; got = (*source)->take(message))
    ASSERT_TRUE(wait_for((*source)->descriptor(), POLLIN, -1));
  ASSERT_FALSE(got);
  EXPECT_EQ(got.error().code, Code::NotFound);
  EXPECT_EQ(got.error().detail, "no peer for 3 s: peer.test: Temporary failure in name resolution");
  ASSERT_FALSE(warnings.lines.empty());
  EXPECT_EQ(warnings.lines[0],
            "tcp:peer.test:7000?reconnect=3: no peer yet (peer.test: Temporary failure in name "
            "resolution); giving up after 3 s");
}

/// As if the network cable were pulled: what comes to the socket is thrown away unanswered.
void cut_off(const Descriptor& socket) {
  sock_filter drop_all = BPF_STMT(BPF_RET | BPF_K, 0);
  sock_fprog program = {1, &drop_all};
  ASSERT_EQ(::setsockopt(socket.get(), SOL_SOCKET, SO_ATTACH_FILTER, &program, sizeof program), 0);
}

// All at once, since the kernel waits for seconds until it gives one up.
TEST(Tcp, WhoVanishesIsNoticed) {
  Warnings warnings;
  const std::string uri = "tcp-listen:" + free_port();
  auto source = source_of(uri, warnings.options());
  auto writer = connect(parse_uri(uri)->rest);
  Message message;
  ASSERT_EQ(*source->take(message), Got::Nothing);
  cut_off(writer);
  std::vector<std::unique_ptr<Sink>> sinks;
  std::vector<Descriptor> readers;
  for (int i = 0; i < 2; ++i) {
    const std::string place = free_port();
    sinks.push_back(sink_of("tcp-listen:" + place + "?readers=1"));
    readers.push_back(connect(place));
    ASSERT_TRUE(sinks.back()->send(numbered(0, 1)));
    cut_off(readers.back());
    ASSERT_TRUE(sinks.back()->send(numbered(1, 1)));
  }
  Status sent;
  for (int i = 2; sent; ++i) sent = sinks[0]->send(numbered(i, 100'000));
  EXPECT_EQ(sent.error().code, Code::Closed);
  // Where its buffer has room, nothing wakes a sink; the peer's kernel is silent for all to see.
  Backoff backoff(std::chrono::milliseconds(1), std::chrono::milliseconds(200));
  sent = {};
  for (int i = 2; sent; ++i) {
    const auto later = std::chrono::steady_clock::now() + backoff.next();
    ASSERT_TRUE(wait_for(-1, 0, -1, later));
    sent = sinks[1]->send(numbered(i, 1));
  }
  EXPECT_EQ(sent.error().code, Code::Closed);
  await_warning(*source, warnings);
  EXPECT_EQ(warnings.lines[0], uri + ": closed a connection: read(): Connection timed out");
}

TEST(Tcp, WhereALinkWasAbandonedAnotherCanListen) {
  const std::string place = free_port();
  auto sink = sink_of("tcp-listen:" + place + "?readers=1");
  auto source = source_of("tcp:" + place + "?reconnect=100");
  ASSERT_TRUE(sink->send(numbered(0, 1)));
  next(*source);
  sink->abandon();  // and is still there
  auto other = sink_of("tcp-listen:" + place + "?readers=1&keep=latest");
  EXPECT_EQ(carry(*other, *source, numbered(1, 1)).header.seq, 1);
}

TEST(Tcp, AConnectionWithItselfIsNone) {
  std::string place = free_port();
  chooses_the_same_port = true;
  auto source = open_source(*parse_uri("tcp:" + place));
  auto patient = source_of("tcp:" + place + "?reconnect=60");
  Message message;
  // A listener could not have its port otherwise.
  EXPECT_EQ(*patient->take(message), Got::Nothing);
  chooses_the_same_port = false;
  ASSERT_FALSE(source);
  EXPECT_EQ(source.error().code, Code::Closed);
  auto sink = sink_of("tcp-listen:" + place + "?readers=1");
  EXPECT_EQ(carry(*sink, *patient, numbered(1, 10)).header.seq, 1);
}

/// Makes sockets of another user, as root can; any other user takes its own for those.
class Foreign {
 public:
  Foreign() {
    if (own_ != 0) is_another = true;
  }
  ~Foreign() { is_another = false; }

  template <typename Make>
  auto make(Make make) {
    EXPECT_EQ(::seteuid(uid_), 0);
    auto made = make();
    EXPECT_EQ(::seteuid(own_), 0);
    return made;
  }
  [[nodiscard]] std::string name() const {
    return "another user (uid " + std::to_string(uid_) + ")";
  }

 private:
  const uid_t own_ = ::geteuid(), uid_ = own_ == 0 ? 65534 : own_;
};

TEST(Tcp, TheSameUserIsLetInWhereNobodyElseIs) {
  const std::string place = free_port();
  auto sink = sink_of("tcp-listen:" + place + "?readers=1&same_user=1");
  auto source = source_of("tcp:" + place + "?same_user=1");
  ASSERT_TRUE(sink->send(numbered(0, 1)));
  next(*source);
  EXPECT_EQ(open_source(*parse_uri("tcp:" + place + "?same_user=2")).error().code, Code::Invalid);
}

TEST(Tcp, AnotherUserIsRefusedWhereOnlyTheSameIsLetIn) {
  Warnings warnings;
  Foreign foreign;
  const std::string uri = "tcp-listen:" + free_port() + "?same_user=1";
  auto source = source_of(uri, warnings.options());
  auto peer = foreign.make([&] { return connect(parse_uri(uri)->rest); });
  const std::string bytes = encode(numbered(0, 1));
  ASSERT_EQ(::send(peer.get(), bytes.data(), bytes.size(), 0), static_cast<ssize_t>(bytes.size()));
  Message message;
  while (warnings.lines.empty()) {
    ASSERT_TRUE(source->wait(-1, std::chrono::milliseconds(-1)));
    ASSERT_EQ(*source->take(message), Got::Nothing);
  }
  EXPECT_EQ(warnings.lines[0], uri + ": refused a peer of " + foreign.name());
}

TEST(Tcp, AListenerOfAnotherUserIsRefused) {
  Foreign foreign;
  auto listening = foreign.make([] { return *listen_on(loopback_address(0), "any"); });
  const std::string place = place_of(listening);
  EXPECT_EQ(refused(open_source(*parse_uri("tcp:" + place + "?same_user=1"))).detail,
            "connect(" + place + "): the listener is a process of " + foreign.name());
  auto peer = connect(place);
  EXPECT_TRUE(tcp_peer_user(peer.get(), Connected::Dialed));
  EXPECT_FALSE(tcp_peer_user(peer.get(), Connected::Accepted));
}

TEST(Tcp, APeerThatHasLeftIsOfNoUser) {
  const auto listening = *listen_on(loopback_address(0), "any");
  auto peer = connect(place_of(listening));
  const Descriptor accepted(::accept(listening.get(), nullptr, nullptr));
  ASSERT_TRUE(accepted);
  EXPECT_TRUE(tcp_peer_user(accepted.get(), Connected::Accepted));
  peer.reset();
  EXPECT_EQ(tcp_peer_user(accepted.get(), Connected::Accepted).error().code, Code::NotFound);
}

TEST(Tcp, AHostWithoutAnAddressIsNotFound) {
  EXPECT_EQ(refused(open_source(*parse_uri("tcp:no.such.host.invalid:80"))).code, Code::NotFound);
  EXPECT_EQ(open_source(*parse_uri("tcp:localhost")).error().code, Code::Invalid);
}

}  // namespace
}  // namespace hc::testing
