// SPDX-License-Identifier: Apache-2.0
#include <web/service.h>

#include <arpa/inet.h>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <net/if.h>
#include <poll.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/wait.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <future>
#include <latch>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include <hc/testing/loopback.h>
#include <hc/testing/must.h>

namespace hc::web {
namespace {

constexpr int kWatchdog = 20'000;  // [ms]

class Hello final : public Site {
 public:
  explicit Hello(std::atomic<int>& closed) : closed_(closed) {}
  Reply reply(const Request& request) override {
    if (request.path == "/fail") throw std::runtime_error("it fails");
    Reply reply;
    reply.body = std::make_shared<const std::string>("hello");
    if (request.path == "/aside")
      reply.aside = [this] {
        waiting.wait();
        return refusal(200, "at last");
      };
    if (request.path == "/aside/fail")
      reply.aside = []() -> Reply { throw std::runtime_error("it fails aside"); };
    if (request.path == "/file") std::swap(reply.file, file), reply.size = 5;
    if (request.path == "/socket") reply.status = 101;
    return reply;
  }
  void open(std::shared_ptr<WebSocket> opened, const Request& /*request*/) override {
    socket = std::move(opened);
    socket->send(std::make_shared<const std::string>(std::size_t{1} << 22, '.'));
    opened_socket.count_down();
  }
  void close() override {
    closed_ += 1, closed_.notify_all();
    if (!socket) return;
    socket->close(1001, "bye");
    on_close();
  }

  std::latch waiting{1};              ///< blocks /aside
  Descriptor file;                    ///< of /file
  std::shared_ptr<WebSocket> socket;  ///< of /socket
  std::latch opened_socket{1};
  std::function<void()> on_close;  ///< of it, called by close()

 private:
  std::atomic<int>& closed_;
};

/// Requests a path over a connection.
void ask(const Descriptor& socket, const std::string& path, const std::string& fields) {
  const std::string request = "GET " + path + " HTTP/1.1\r\nHost: localhost\r\n" + fields + "\r\n";
  EXPECT_EQ(::send(socket.get(), request.data(), request.size(), MSG_NOSIGNAL),
            std::ssize(request));
}

/// Connects, and requests a path.
Descriptor ask(std::uint16_t port, const std::string& path,
               const std::string& fields = "Connection: close\r\n") {
  Descriptor socket(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
  const auto place = testing::loopback(port);
  EXPECT_EQ(::connect(socket.get(), reinterpret_cast<const sockaddr*>(&place), sizeof place), 0);
  ask(socket, path, fields);
  return socket;
}

bool is_readable(int descriptor) {
  pollfd polled{descriptor, POLLIN, 0};
  return ::poll(&polled, 1, kWatchdog) == 1;
}

/// All that arrives, up to what ends with a text.
std::string answer(int socket, std::string_view end = "\xff") {
  std::string all;
  std::array<char, 1024> part;
  while (!all.ends_with(end) && is_readable(socket)) {
    const auto got = ::recv(socket, part.data(), part.size(), 0);
    if (got <= 0) break;
    all.append(part.data(), static_cast<std::size_t>(got));
  }
  return all;
}

class ServiceTest : public ::testing::Test {
 protected:
  Hello& serve() { return service_->serve(std::make_unique<Hello>(closed_)); }
  [[nodiscard]] std::uint16_t port() const { return service_->server().port(); }
  [[nodiscard]] std::string get(const std::string& path) const {
    return answer(ask(port(), path).get());
  }
  /// Runs the calls that were posted to the loop.
  void turn() {
    ASSERT_TRUE(is_readable(loop_->descriptor()));
    ASSERT_TRUE(loop_->turn(std::chrono::milliseconds(0)));
  }

  const std::unique_ptr<Loop> loop_ = must(Loop::make());
  std::vector<std::string> logged_;
  std::atomic<int> closed_ = 0;  // outlives the service
  std::unique_ptr<Service> service_ = must(
      Service::open({}, *loop_, [this](std::string_view line) { logged_.emplace_back(line); }));
};

TEST_F(ServiceTest, a_port_that_is_in_use_is_named) {
  const auto taken = service_->access().place().port;
  std::vector<std::string> lines;
  const auto second = must(Service::open({.port = taken}, *loop_,
                                         [&](std::string_view line) { lines.emplace_back(line); }));
  const auto used = second->access().place().port;
  EXPECT_NE(used, taken);
  EXPECT_EQ(lines, std::vector{"port " + std::to_string(taken) + " is in use; listening at port " +
                               std::to_string(used)});
}

TEST_F(ServiceTest, serves_a_site_and_closes_it_at_the_end) {
  serve();
  EXPECT_EQ(service_->access().place().port, port());
  EXPECT_EQ(service_->fingerprint(), "");
  EXPECT_TRUE(get("/").ends_with("\r\n\r\nhello"));
  EXPECT_EQ(closed_, 0);
  service_.reset();
  EXPECT_EQ(closed_, 1);
}

constexpr int kSkipped = 77;

/// Puts this process into a new network namespace with all addresses 10.….
bool move_to_own_network() {
  if (::unshare(CLONE_NEWNET) != 0 && ::unshare(CLONE_NEWUSER | CLONE_NEWNET) != 0) return false;
  const Descriptor socket(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  ifreq lo{};
  std::strcpy(lo.ifr_name, "lo");
  lo.ifr_flags = IFF_UP;
  if (::ioctl(socket.get(), SIOCSIFFLAGS, &lo) != 0) return false;
  auto place = testing::loopback(0);
  ::inet_pton(AF_INET, "10.0.0.1", &place.sin_addr);
  std::memcpy(&lo.ifr_addr, &place, sizeof place);
  return ::ioctl(socket.get(), SIOCSIFADDR, &lo) == 0;
}

/// Runs in its own process.
void push_a_crowd_of_one_host_at_another_one() {
  if (!move_to_own_network()) std::exit(kSkipped);
  auto server = Server::listen("::", 0, 1, "", [](Level, std::string_view) {});
  if (!server) std::exit(kSkipped);  // no IPv6 here
  std::atomic<int> closed = 0;
  Hello site(closed);
  std::thread thread([&] { (*server)->run(site); });
  const auto connect = [&](const char* from) {
    Descriptor socket(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
    auto place = testing::loopback(0);
    EXPECT_EQ(::inet_pton(AF_INET, from, &place.sin_addr), 1);
    EXPECT_EQ(::bind(socket.get(), reinterpret_cast<const sockaddr*>(&place), sizeof place), 0);
    place.sin_port = htons((*server)->port());
    EXPECT_EQ(::connect(socket.get(), reinterpret_cast<const sockaddr*>(&place), sizeof place), 0);
    return socket;
  };
  const auto one = connect("10.0.0.2");
  std::vector<Descriptor> crowd;
  while (crowd.size() < 200) crowd.push_back(connect("10.0.0.1"));  // above the limit of strangers
  EXPECT_TRUE(is_readable(crowd.front().get())) << "the crowd's oldest is closed";
  const std::string request = "GET / HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n";
  EXPECT_EQ(::send(one.get(), request.data(), request.size(), MSG_NOSIGNAL), std::ssize(request));
  EXPECT_TRUE(answer(one.get()).ends_with("\r\n\r\nhello"));
  (*server)->stop();
  thread.join();
  std::exit(::testing::Test::HasFailure() ? 1 : 0);
}

TEST(Server, hosts_of_ipv4_are_told_apart_at_a_socket_of_ipv6) {
  bool is_skipped = false;
  const auto ends_well = [&](int status) {
    is_skipped = WIFEXITED(status) && WEXITSTATUS(status) == kSkipped;
    return is_skipped || status == 0;
  };
  EXPECT_EXIT(push_a_crowd_of_one_host_at_another_one(), ends_well, "");
  if (is_skipped) GTEST_SKIP() << "no network of its own, or no IPv6, here";
}

TEST_F(ServiceTest, logs_in_the_loop_alone) {
  serve();
  const auto failed = ask(port(), "/fail");
  ASSERT_TRUE(is_readable(loop_->descriptor()));
  EXPECT_TRUE(logged_.empty());
  turn();
  EXPECT_EQ(logged_, std::vector<std::string>{"server: it fails"});
}

TEST_F(ServiceTest, a_call_that_throws_is_logged_and_made_again) {
  std::atomic<int> calls = 0;
  service_->server().every(std::chrono::milliseconds(1), [&] {
    if (++calls < 3) throw std::runtime_error("it fails");
  });
  serve();
  while (logged_.size() < 2) turn();
  EXPECT_EQ(logged_[1], "server: it fails");
  EXPECT_TRUE(get("/").ends_with("\r\n\r\nhello"));
  service_.reset();  // calls close()
}

TEST_F(ServiceTest, what_waits_for_a_disk_holds_nobody_up) {
  std::array<int, 2> ends;  // of a pipe that simulates a slow disk
  ASSERT_EQ(::pipe2(ends.data(), O_CLOEXEC), 0);
  const Descriptor disk(ends[1]);
  auto site = std::make_unique<Hello>(closed_);
  site->file = Descriptor(ends[0]);
  Hello& hello = service_->serve(std::move(site));
  const auto slow = ask(port(), "/aside"), file = ask(port(), "/file");
  EXPECT_TRUE(get("/").ends_with("\r\n\r\nhello"));
  hello.waiting.count_down();
  EXPECT_TRUE(answer(slow.get()).ends_with("\r\n\r\nat last\n"));
  EXPECT_EQ(::write(disk.get(), "12345", 5), 5);
  EXPECT_TRUE(answer(file.get()).ends_with("\r\n\r\nhello12345"));
}

TEST_F(ServiceTest, work_aside_goes_on_in_the_servers_thread_and_is_logged_where_it_throws) {
  auto& server = service_->server();
  std::promise<std::array<std::thread::id, 3>> threads;
  server.post([&] {
    EXPECT_TRUE(server.aside([&, here = std::this_thread::get_id()] {
      return [&, here, beside = std::this_thread::get_id()] {
        threads.set_value({here, beside, std::this_thread::get_id()});
      };
    }));
  });
  serve();
  const auto [before, beside, after] = threads.get_future().get();
  EXPECT_EQ(before, after);
  EXPECT_NE(before, beside);
  EXPECT_EQ(get("/aside/fail"), "");
  turn();
  EXPECT_EQ(logged_, std::vector<std::string>{"server: it fails aside"});
}

TEST_F(ServiceTest, ends_after_the_work_aside) {
  bool is_done = false;
  auto& server = service_->server();
  std::latch begun(1);
  server.post([&] {
    EXPECT_TRUE(server.aside([&] {
      begun.count_down();
      closed_.wait(0);
      is_done = true;
      return [] {};
    }));
  });
  serve();
  begun.wait();
  service_.reset();
  EXPECT_TRUE(is_done);
}

TEST_F(ServiceTest, ends_after_a_slow_client_has_heard_why_and_takes_no_other_meanwhile) {
  Hello& hello = serve();
  const std::string upgrade =
      "Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
      "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n";
  const auto place = testing::loopback(port());
  const auto client = ask(port(), "/socket", upgrade), idle = ask(port(), "/", "");
  EXPECT_TRUE(answer(idle.get(), "hello").ends_with("hello"));
  hello.opened_socket.wait();
  auto& server = service_->server();
  std::promise<void> moment;
  Loop::Handle timer;
  server.post([&] {
    hello.on_close = [&] {
      // Later than a server without sockets ends.
      timer =
          server.loop().call_at(std::chrono::steady_clock::now() + std::chrono::milliseconds(250),
                                [&] { moment.set_value(), timer.reset(); });
    };
  });
  std::thread ending([this] { service_.reset(); });
  EXPECT_EQ(moment.get_future().wait_for(std::chrono::milliseconds(kWatchdog)),
            std::future_status::ready);
  const std::string close =
      "\x88\x05\x03\xe9"
      "bye";
  const Descriptor late(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
  EXPECT_EQ(::connect(late.get(), reinterpret_cast<const sockaddr*>(&place), sizeof place), -1);
  EXPECT_EQ(errno, ECONNREFUSED);
  ask(idle, "/socket", upgrade);
  EXPECT_EQ(answer(idle.get()), "");
  EXPECT_TRUE(answer(client.get(), close).ends_with(close));
  EXPECT_EQ(::shutdown(client.get(), SHUT_WR), 0);
  ending.join();
}

TEST_F(ServiceTest, ends_though_it_served_nothing) {
  service_.reset();
}

}  // namespace
}  // namespace hc::web
