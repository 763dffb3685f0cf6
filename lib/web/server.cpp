// SPDX-License-Identifier: Apache-2.0
#include <web/server.h>

#include <netinet/in.h>
#include <unistd.h>

#include <algorithm>
#include <list>
#include <optional>
#include <utility>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <boost/asio/ssl/context.hpp>
#include <boost/asio/steady_timer.hpp>

#include <hc/os/peer_user.h>
#include <hc/os/socket.h>
#include <web/connection.h>
#include <web/visitor.h>

namespace hc::web {

namespace {

namespace asio = boost::asio;
using tcp = asio::ip::tcp;

constexpr std::size_t kMaxStrangers = 128;

Peer peer_of(tcp::socket& socket) {
  const auto user = tcp_peer_user(socket.native_handle(), Connected::Accepted);
  if (user) return {"user " + std::to_string(*user), *user != ::geteuid() && *user != 0};
  boost::system::error_code error;
  const auto address = socket.remote_endpoint(error).address();
  if (error || !address.is_v6()) return {address.to_string()};
  constexpr std::size_t kNetwork = 8;  // [byte]
  const auto six = address.to_v6();
  if (six.is_v4_mapped()) return {asio::ip::make_address_v4(asio::ip::v4_mapped, six).to_string()};
  const auto bytes = six.to_bytes();
  return {{bytes.begin(), bytes.begin() + kNetwork}};
}

class BeastServer final : public Server {
 public:
  BeastServer(LogSink log, std::unique_ptr<Loop> loop) : loop_(std::move(loop)) {
    shared_->log = std::move(log);
    shared_->loop = loop_.get();
  }
  ~BeastServer() override { loop_ready_.release(); }  // the loop owns the descriptor

  Status open(const std::string& address, std::uint16_t first, int ports) {
    boost::system::error_code error;
    const auto parsed = asio::ip::make_address(address, error);
    if (error) return Error{Code::Invalid, "listen: \"" + address + "\" is not an IP address"};
    for (int i = 0; i < ports; ++i) {
      const tcp::endpoint place(parsed, static_cast<std::uint16_t>(first == 0 ? 0 : first + i));
      acceptor_ = tcp::acceptor(context_);
      error = {};
      acceptor_.open(place.protocol(), error);
      const int on = 1;  // as bind_socket(): the host may get the address later
      if (!error) acceptor_.set_option(asio::socket_base::reuse_address(true), error);
      if (!error) ::setsockopt(acceptor_.native_handle(), IPPROTO_IP, IP_FREEBIND, &on, sizeof on);
      if (!error) acceptor_.bind(place, error);
      if (!error) acceptor_.listen(asio::socket_base::max_listen_connections, error);
      if (!error || error != asio::error::address_in_use) break;
    }
    if (error)
      return Error{Code::System,
                   "listen on " + address + ", port " + std::to_string(first) +
                       (ports > 1 ? " to " + std::to_string(first + ports - 1) : std::string()) +
                       ": " + error.message()};
    const auto place = acceptor_.local_endpoint();
    if (!is_of_this_host({place.data(), static_cast<unsigned>(place.size())}))
      shared_->log(Level::Warning, "listen " + address + ": " + kNotOfThisHost);
    return {};
  }

  Status use(const std::string& identity) {
    // TLS 1.3 only.
    using Tls = asio::ssl::context;
    secure_.emplace(Tls::tls_server);
    boost::system::error_code error;
    secure_->set_options(Tls::default_workarounds | Tls::no_sslv2 | Tls::no_sslv3 | Tls::no_tlsv1 |
                             Tls::no_tlsv1_1 | Tls::no_tlsv1_2,
                         error);
    if (!error) secure_->use_certificate_chain(asio::buffer(identity), error);
    if (!error) secure_->use_private_key(asio::buffer(identity), Tls::pem, error);
    if (error) return Error{Code::System, "certificate: " + error.message()};
    return {};
  }

  [[nodiscard]] std::uint16_t port() const override { return acceptor_.local_endpoint().port(); }

  void run(Site& site) override {
    shared_->site = &site;
    accept();
    turn_loop();
    // Continue after exceptions of posted functions.
    while (!shared_->guard([&] { context_.run(); })) {
    }
    shared_->asides.clear();
    shared_->on_last = nullptr;
  }
  void stop() override {
    loop_->post([this] {
      // A client that connects again would be cut off, and not hear why.
      shared_->is_ending = true;
      boost::system::error_code ignored;
      acceptor_.close(ignored);
      constexpr std::chrono::milliseconds kMoment{200}, kMost{4000};
      const auto now = std::chrono::steady_clock::now();
      stop_ = loop_->call_at(now + kMoment, [this] {
        if (shared_->sockets == 0) return context_.stop();
        shared_->on_last = [this] { context_.stop(); };
      });
      give_up_ = loop_->call_at(now + kMost, [this] { context_.stop(); });
    });
  }
  Loop& loop() override { return *loop_; }
  void post(std::function<void()> call) override {
    loop_->post([shared = shared_, call = std::move(call)] { shared->guard(call); });
  }
  Status aside(Work work) override { return shared_->aside(std::move(work)); }

  void every(std::chrono::milliseconds period, std::function<void()> call) override {
    auto& timer = timers_.emplace_back();
    timer = loop_->call_at(std::chrono::steady_clock::now(),
                           [shared = shared_, &timer, period, call = std::move(call)] {
                             timer.call_at(std::chrono::steady_clock::now() + period);
                             shared->guard(call);
                           });
  }

 private:
  /// Turns the loop whenever it is ready.
  void turn_loop() {
    loop_ready_.async_wait(asio::posix::descriptor_base::wait_read,
                           [this](boost::system::error_code error) {
                             if (error) return;
                             turn_loop();  // first, since turn() may throw
                             static_cast<void>(loop_->turn(std::chrono::milliseconds(0)));
                           });
  }

  void accept() {
    acceptor_.async_accept([this](boost::system::error_code error, tcp::socket socket) {
      if (shared_->is_ending) return;
      if (error) {
        // Usually out of descriptors. If closing a stranger cannot free one, retry later.
        if (error != asio::error::no_descriptors || !Visitor::drop_one(*shared_)) {
          shared_->log(Level::Warning, "server: accept: " + error.message());
          auto timer = std::make_shared<asio::steady_timer>(context_, std::chrono::seconds(1));
          return timer->async_wait([this, timer](boost::system::error_code) { accept(); });
        }
      } else {
        shared_->guard([&] { begin(std::move(socket)); });
      }
      accept();
    });
  }

  void begin(tcp::socket socket) {
    auto visitor = std::make_shared<Visitor>(shared_, peer_of(socket));
    if (shared_->strangers.size() > kMaxStrangers) Visitor::drop_one(*shared_);
    serve(std::move(socket), secure_ ? &*secure_ : nullptr, std::move(visitor));
  }

  std::shared_ptr<Shared> shared_ = std::make_shared<Shared>();
  std::optional<asio::ssl::context> secure_;
  asio::io_context context_{1};
  tcp::acceptor acceptor_{context_};
  std::unique_ptr<Loop> loop_;
  asio::posix::stream_descriptor loop_ready_{context_, loop_->descriptor()};
  std::list<Loop::Handle> timers_;
  Loop::Handle stop_, give_up_;
};

}  // namespace

Reply refusal(int status, const std::string& words) {
  Reply reply;
  reply.status = status;
  reply.body = std::make_shared<const std::string>(words + "\n");
  return reply;
}

std::string_view option(std::string_view query, std::string_view name) {
  while (!query.empty()) {
    const auto each = query.substr(0, query.find('&'));
    query.remove_prefix(std::min(query.size(), each.size() + 1));
    if (each.starts_with(name) && each.size() > name.size() && each[name.size()] == '=')
      return each.substr(name.size() + 1);
  }
  return {};
}

Result<std::unique_ptr<Server>> Server::listen(const std::string& address, std::uint16_t port,
                                               int ports, const std::string& identity,
                                               LogSink log) {
  auto loop = Loop::make();
  if (!loop) return loop.error();
  auto server = std::make_unique<BeastServer>(std::move(log), std::move(*loop));
  if (auto opened = server->open(address, port, ports); !opened) return opened.error();
  if (!identity.empty())
    if (auto used = server->use(identity); !used) return used.error();
  return std::unique_ptr<Server>(std::move(server));
}

}  // namespace hc::web
