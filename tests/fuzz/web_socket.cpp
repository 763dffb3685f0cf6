// SPDX-License-Identifier: Apache-2.0
// Any bytes to the server of pages and viewers, as an HTTP request or in a WebSocket: it closes the
// connection, and the next one is served.
#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <string>
#include <thread>

#include <hc/base/check.h>
#include <web/server.h>

namespace {

namespace web = hc::web;

/// Answers with what it hears.
struct Echo final : web::Site {
  web::Reply reply(const web::Request& request) override {
    static_cast<void>(web::option(request.query, "token"));
    web::Reply reply;
    reply.status = request.is_socket ? 101 : 404;
    return reply;
  }
  void open(std::shared_ptr<web::WebSocket> socket, const web::Request&) override {
    auto& events = *socket;
    events.on_text = [&events](std::string_view text) { events.send_text(std::string(text)); };
    events.on_binary = [&events](std::string_view bytes) {
      events.send(std::make_shared<const std::string>(bytes), "head");
    };
    events.on_close = [kept = std::move(socket)] {};
  }
};

/// Serves as long as the program runs.
std::uint16_t port() {
  // Not destroyed at the end, when its thread still runs.
  static auto* echo = new Echo;
  static auto* server =
      web::Server::listen("127.0.0.1", 0, 1, "", [](auto...) {}).value().release();
  static const bool runs = (std::thread([] { server->run(*echo); }).detach(), true);
  static_cast<void>(runs);
  return server->port();
}

constexpr std::string_view kHandshake =
    "GET / HTTP/1.1\r\nHost: localhost\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
    "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n";

}  // namespace

/// The first byte says whether the others come in a WebSocket.
int fuzz_web_socket(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port());
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  const int connection = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  // An address has some 28,000 ports, and each is of no use for a minute after its connection.
  static std::uint32_t runs = 0;
  constexpr std::uint32_t kRuns = 20'000, kAddresses = 250;
  sockaddr_in own{};
  own.sin_family = AF_INET;
  own.sin_addr.s_addr = htonl(INADDR_LOOPBACK + runs++ / kRuns % kAddresses);
  const int no_port = 1;
  ::setsockopt(connection, IPPROTO_IP, IP_BIND_ADDRESS_NO_PORT, &no_port, sizeof no_port);
  HC_CHECK(::bind(connection, reinterpret_cast<const sockaddr*>(&own), sizeof own) == 0);
  if (::connect(connection, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    HC_CHECK(errno == EINTR, std::strerror(errno));  // libFuzzer looks at the clock
    ::close(connection);
    return 0;
  }
  const timeval hangs{20, 0};
  ::setsockopt(connection, SOL_SOCKET, SO_RCVTIMEO, &hangs, sizeof hangs);
  std::string bytes((data[0] & 1) != 0 ? kHandshake : std::string_view());
  bytes.append(reinterpret_cast<const char*>(data) + 1, size - 1);
  [[maybe_unused]] const auto sent = ::send(connection, bytes.data(), bytes.size(), MSG_NOSIGNAL);
  ::shutdown(connection, SHUT_WR);
  std::array<char, 4096> answer;
  ssize_t got = 0;
  while ((got = ::recv(connection, answer.data(), answer.size(), 0)) > 0) continue;
  HC_CHECK(got == 0 || (errno != EAGAIN && errno != EWOULDBLOCK), "the connection stays open");
  ::close(connection);
  return 0;
}
