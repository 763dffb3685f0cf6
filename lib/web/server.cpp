// SPDX-License-Identifier: Apache-2.0
#include <web/server.h>

#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <deque>
#include <exception>
#include <future>
#include <list>
#include <map>
#include <optional>
#include <sstream>
#include <type_traits>

#include <hc/os/aside.h>
#include <hc/os/peer_user.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <boost/asio/ssl.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/ssl.hpp>
#include <boost/beast/websocket.hpp>
#include <boost/beast/websocket/ssl.hpp>

namespace hc::web {

namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using tcp = asio::ip::tcp;
using Plain = beast::tcp_stream;
using Secure = beast::ssl_stream<beast::tcp_stream>;

constexpr std::size_t kMaxHead = 8192, kMaxMessage = 65536;  // [byte]
constexpr std::size_t kMaxStrangers = 128, kMaxKnown = 768;
constexpr std::size_t kPiece = 262144;  // for reading files [byte]
constexpr std::chrono::seconds kHeadTime{5}, kIdleTime{30};
constexpr std::chrono::seconds kPongTime{10};  // of a silent WebSocket

/// Decodes %-escapes; nullopt if they are malformed or encode a zero byte.
std::optional<std::string> decoded(std::string_view text) {
  std::string plain;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '%') {
      plain += text[i];
      continue;
    }
    const auto digits = text.substr(i + 1, 2);
    unsigned code = 0;
    const char* end = digits.data() + digits.size();
    if (digits.size() < 2 || std::from_chars(digits.data(), end, code, 16).ptr != end || code == 0)
      return std::nullopt;
    plain += static_cast<char>(code);
    i += 2;
  }
  return plain;
}

std::string_view view_of(const beast::string_view& text) {
  return {text.data(), text.size()};
}

template <typename Fields>
std::optional<Request> request_of(const http::request<http::empty_body, Fields>& head) {
  const std::string_view target = view_of(head.target());
  const auto mark = std::min(target.find('?'), target.size());
  auto path = decoded(target.substr(0, mark));
  if (!path || !path->starts_with('/')) return std::nullopt;
  Request request;
  request.path = std::move(*path);
  request.query = target.substr(std::min(target.size(), mark + 1));
  request.host = view_of(head[http::field::host]);
  request.origin = view_of(head[http::field::origin]);
  request.cookies = view_of(head[http::field::cookie]);
  request.protocols = view_of(head[http::field::sec_websocket_protocol]);
  request.is_socket = websocket::is_upgrade(head);
  return request;
}

class Visitor;

/// Shared by all connections.
struct Shared {
  Site* site = nullptr;
  Loop* loop = nullptr;
  LogSink log;
  std::list<Visitor*> strangers;  // without a session, oldest first
  std::size_t known = 0;          // number of visitors with a session
  std::list<Aside> asides;        // running

  /// Calls a function of a site and logs exceptions. @returns  false if it has thrown.
  template <typename Call>
  bool guard(const Call& call) const {
    try {
      call();
      return true;
    } catch (const std::exception& error) {
      log(Level::Error, std::string("server: ") + error.what());
      return false;
    }
  }

  /// As Server::aside().
  Status aside(Work work) {
    using Then = std::function<void()>;
    const auto place = asides.emplace(asides.end());
    const auto kept = std::make_shared<Work>(std::move(work));
    auto begun = run_aside(
        *loop,
        [kept](int) {
          std::packaged_task<Then()> task(std::ref(*kept));
          auto then = task.get_future();
          task();
          return then;
        },
        [this, place, kept](std::future<Then> then) {
          asides.erase(place);
          guard([&] { then.get()(); });
        });
    if (begun) {
      std::swap(*place, *begun);
      return {};
    }
    // Never run it on this thread: while it waits for a disk, a stop could not arrive.
    asides.erase(place);
    return Error{Code::System, "the server is too busy for this (" + begun.error().detail +
                                   "); try again in a moment"};
  }
};

/// The other end of a connection.
struct Peer {
  std::string name;              ///< local user, IPv4 address, or IPv6 network
  bool is_another_user = false;  ///< another local user, except root
};

/// Counts a connection for its lifetime, as a stranger until it has shown a session.
class Visitor {
 public:
  Visitor(std::shared_ptr<Shared> shared, Peer peer)
      : shared_(std::move(shared)), peer_(std::move(peer)) {
    shared_->strangers.push_back(this);
  }
  Visitor(const Visitor&) = delete;
  Visitor& operator=(const Visitor&) = delete;
  ~Visitor() {
    if (is_known_)
      --shared_->known;
    else
      std::erase(shared_->strangers, this);
  }

  /// Call this when it has shown a session. @returns  false if there is no room for it.
  bool know() {
    if (is_known_) return true;
    if (shared_->known >= kMaxKnown) return false;
    std::erase(shared_->strangers, this);
    ++shared_->known;
    return is_known_ = true;
  }
  [[nodiscard]] Shared& shared() const { return *shared_; }
  [[nodiscard]] const Peer& peer() const { return peer_; }
  [[nodiscard]] Site& site() const { return *shared_->site; }

  /// Closes the oldest stranger of the peer that has most of them; false: there are none.
  static bool drop_one(Shared& shared) {
    std::map<std::string_view, std::size_t> counts;
    for (const auto* stranger : shared.strangers) ++counts[stranger->peer_.name];
    std::size_t most = 0;
    for (const auto& [source, count] : counts) most = std::max(most, count);
    const auto oldest = std::ranges::find_if(
        shared.strangers, [&](const auto* each) { return counts[each->peer_.name] == most; });
    if (oldest == shared.strangers.end()) return false;
    const auto close = (*oldest)->close;
    shared.strangers.erase(oldest);
    if (close) close();
    return true;
  }

  std::function<void()> close;  ///< closes its socket

 private:
  const std::shared_ptr<Shared> shared_;
  const Peer peer_;
  bool is_known_ = false;
};

Peer peer_of(tcp::socket& socket) {
  const auto user = tcp_peer_user(socket.native_handle(), Connected::Accepted);
  if (user) return {"user " + std::to_string(*user), *user != ::geteuid() && *user != 0};
  beast::error_code error;
  const auto address = socket.remote_endpoint(error).address();
  if (error || !address.is_v6()) return {address.to_string()};
  constexpr std::size_t kNetwork = 8;  // [byte]
  const auto six = address.to_v6();
  if (six.is_v4_mapped()) return {asio::ip::make_address_v4(asio::ip::v4_mapped, six).to_string()};
  const auto bytes = six.to_bytes();
  return {{bytes.begin(), bytes.begin() + kNetwork}};
}

/// A WebSocket over a stream of either kind, kept alive by the page's handlers and by pending I/O.
template <typename Stream>
class Socket final : public WebSocket, public std::enable_shared_from_this<Socket<Stream>> {
 public:
  Socket(Stream&& stream, std::shared_ptr<Visitor> visitor)
      : stream_(std::move(stream)), visitor_(std::move(visitor)) {}

  void accept(http::request<http::empty_body> head, Request request, const Reply& reply) {
    beast::get_lowest_layer(stream_).expires_never();
    stream_.set_option(websocket::stream_base::timeout{kHeadTime, kPongTime, true});
    stream_.read_message_max(kMaxMessage);
    stream_.auto_fragment(false);
    websocket::permessage_deflate off;
    off.server_enable = false;
    stream_.set_option(off);
    stream_.set_option(websocket::stream_base::decorator(
        [fields = reply.fields](websocket::response_type& response) {
          for (const auto& [name, value] : fields) response.set(name, value);
        }));
    // A small buffer in the kernel, for low latency.
    beast::error_code ignored;
    beast::get_lowest_layer(stream_).socket().set_option(
        asio::socket_base::send_buffer_size(1 << 17), ignored);
    beast::get_lowest_layer(stream_).socket().set_option(tcp::no_delay(true), ignored);
    auto kept = std::make_shared<http::request<http::empty_body>>(std::move(head));
    stream_.async_accept(*kept, [self = this->shared_from_this(), kept,
                                 asked = std::move(request)](beast::error_code error) {
      if (error) return;
      if (!self->visitor_->shared().guard([&] { self->visitor_->site().open(self, asked); }))
        return self->lose();
      self->read();
    });
  }

  void send_text(std::string text) override {
    add({true, {}, std::make_shared<const std::string>(std::move(text))});
  }
  void send(Bytes message, std::string head) override {
    add({false, std::move(head), std::move(message)});
  }
  [[nodiscard]] std::size_t waiting() const override { return queue_.size(); }

  void close(int code, std::string reason) override {
    forget();
    if (closing_) return;
    constexpr std::size_t kMaxReason = 123;  // of RFC 6455
    reason.resize(std::min(reason.size(), kMaxReason));
    closing_.emplace(static_cast<std::uint16_t>(code), std::move(reason));
    queue_.resize(is_writing_ ? 1 : 0);
    if (!is_writing_) finish();
  }

 private:
  struct Outgoing {
    bool is_text = false;
    std::string head;
    Bytes bytes;
  };

  void add(Outgoing outgoing) {
    if (closing_) return;
    queue_.push_back(std::move(outgoing));
    if (!is_writing_) write();
  }

  void write() {
    is_writing_ = true;
    const Outgoing& next = queue_.front();
    stream_.text(next.is_text);
    stream_.async_write(std::array{asio::buffer(next.head), asio::buffer(*next.bytes)},
                        [self = this->shared_from_this()](beast::error_code error, std::size_t) {
                          self->is_writing_ = false;
                          self->queue_.pop_front();
                          if (error) return self->lose();
                          if (self->closing_) return self->finish();
                          if (!self->queue_.empty()) self->write();
                          if (const auto sent = self->on_sent)
                            if (!self->visitor_->shared().guard(sent)) self->lose();
                        });
  }

  void finish() {
    const auto& [code, text] = *closing_;
    stream_.async_close(websocket::close_reason(static_cast<websocket::close_code>(code), text),
                        [self = this->shared_from_this()](beast::error_code) {});
  }

  void read() {
    stream_.async_read(
        buffer_, [self = this->shared_from_this()](beast::error_code error, std::size_t) {
          if (error) return self->lose();
          const auto data = self->buffer_.data();
          const std::string_view text(static_cast<const char*>(data.data()), data.size());
          // A handler may replace itself.
          const auto handler = self->stream_.got_text() ? self->on_text : self->on_binary;
          if (handler && !self->visitor_->shared().guard([&] { handler(text); }))
            return self->lose();
          self->buffer_.consume(self->buffer_.size());
          self->read();
        });
  }

  void lose() {
    const auto closed = on_close;
    forget();
    if (closed) visitor_->shared().guard(closed);
  }
  void forget() { on_text = on_binary = nullptr, on_sent = on_close = nullptr; }

  websocket::stream<Stream> stream_;
  std::shared_ptr<Visitor> visitor_;
  beast::flat_buffer buffer_;
  std::deque<Outgoing> queue_;  // the first is being written
  bool is_writing_ = false;
  std::optional<std::pair<std::uint16_t, std::string>> closing_;
};

/// A connection that speaks HTTP.
template <typename Stream>
class Connection : public std::enable_shared_from_this<Connection<Stream>> {
 public:
  Connection(Stream&& stream, std::shared_ptr<Visitor> visitor)
      : stream_(std::move(stream)), visitor_(std::move(visitor)) {}

  void begin() {
    visitor_->close = [weak = this->weak_from_this()] {
      if (const auto self = weak.lock()) beast::get_lowest_layer(self->stream_).close();
    };
    if constexpr (std::is_same_v<Stream, Secure>) {
      beast::get_lowest_layer(stream_).expires_after(kHeadTime);
      stream_.async_handshake(asio::ssl::stream_base::server,
                              [self = this->shared_from_this()](beast::error_code error) {
                                if (!error) self->read();
                              });
    } else {
      read();
    }
  }

 private:
  void read() {
    parser_.emplace();
    parser_->header_limit(kMaxHead);
    parser_->body_limit(0);
    beast::get_lowest_layer(stream_).expires_after(kHeadTime);
    http::async_read(stream_, buffer_, *parser_,
                     [self = this->shared_from_this()](beast::error_code error, std::size_t) {
                       self->take(error);
                     });
  }

  void take(beast::error_code error) {
    if (error == http::error::header_limit || error == http::error::body_limit)
      return write(refusal(431, "the request is too large"), false);
    if (error == beast::error::timeout || error == http::error::end_of_stream) return;
    if (error.category() == http::make_error_code(http::error::bad_line_ending).category())
      return write(refusal(400, "not an HTTP request"), false);
    if (error) return;
    auto head = parser_->release();
    auto request = request_of(head);
    if (!request) return write(refusal(400, "the path is malformed"), false);
    if (head.method() != http::verb::get) return write(refusal(405, "only GET is served"), false);
    request->is_another_user = visitor_->peer().is_another_user;
    const bool keeps = head.keep_alive() && !request->is_socket;
    Reply reply;
    if (!visitor_->shared().guard([&] { reply = visitor_->site().reply(*request); })) return;
    if (reply.status < 400 && !visitor_->know())
      return write(refusal(503, "too many connections are open"), false);
    if (reply.aside) {
      const auto begun = visitor_->shared().aside(
          [self = this->shared_from_this(), keeps, make = std::move(reply.aside)] {
            const auto made = std::make_shared<Reply>(make());
            return [self, keeps, made] { self->write(std::move(*made), keeps); };
          });
      if (!begun) write(refusal(503, begun.error().detail), keeps);
      return;
    }
    if (reply.status != 101) return write(std::move(reply), keeps);
    visitor_->close = nullptr;
    std::make_shared<Socket<Stream>>(std::move(stream_), visitor_)
        ->accept(std::move(head), std::move(*request), reply);
  }

  void write(Reply reply, bool keeps) {
    http::response<http::empty_body> response;
    response.version(11);
    response.result(static_cast<unsigned>(reply.status));
    response.set(http::field::content_type, reply.type);
    response.set("X-Content-Type-Options", "nosniff");
    response.set("Referrer-Policy", "no-referrer");
    response.set("Cross-Origin-Opener-Policy", "same-origin");
    response.set("Cross-Origin-Resource-Policy", "same-origin");
    for (const auto& [name, value] : reply.fields) response.set(name, value);
    response.keep_alive(keeps);
    reply_ = std::move(reply);
    const std::string_view body = reply_.body ? std::string_view(*reply_.body) : "";
    response.content_length(body.size() + reply_.size);
    std::ostringstream head;
    head << response.base();
    piece_ = head.str();
    // The body is shared by all pages, so it is not copied.
    left_ = Left(Buffers{asio::buffer(piece_), asio::buffer(body)});
    write_on(keeps);
  }

  /// Writes the next part of the reply. The timeout applies to each part, not to the whole.
  void write_on(bool keeps) {
    if (beast::buffer_bytes(left_) == 0) {
      if (reply_.size == 0) return keeps ? read() : end();
      return read_piece(keeps);
    }
    beast::get_lowest_layer(stream_).expires_after(kIdleTime);
    stream_.async_write_some(left_, [self = this->shared_from_this(), keeps](
                                        beast::error_code error, std::size_t written) {
      if (error) return;
      self->left_.consume(written);
      self->write_on(keeps);
    });
  }

  /// Reads the next piece of the file, on another thread.
  void read_piece(bool keeps) {
    const auto begun = visitor_->shared().aside([self = this->shared_from_this(), keeps] {
      self->piece_.resize(std::min<std::uint64_t>(kPiece, self->reply_.size));
      const auto got = ::read(self->reply_.file.get(), self->piece_.data(), self->piece_.size());
      return [self, keeps, got] {
        if (got <= 0) return beast::get_lowest_layer(self->stream_).close();
        self->reply_.size -= static_cast<std::uint64_t>(got);
        self->left_ = Left(Buffers{asio::buffer(self->piece_, static_cast<std::size_t>(got))});
        self->write_on(keeps);
      };
    });
    if (!begun) beast::get_lowest_layer(stream_).close();
  }

  void end() {
    beast::error_code ignored;
    beast::get_lowest_layer(stream_).socket().shutdown(tcp::socket::shutdown_send, ignored);
  }

  Stream stream_;
  std::shared_ptr<Visitor> visitor_;
  beast::flat_buffer buffer_{kMaxHead};
  std::optional<http::request_parser<http::empty_body>> parser_;
  // While writing:
  Reply reply_;
  std::string piece_;  // the head, or a piece of the file
  using Buffers = std::array<asio::const_buffer, 2>;
  using Left = beast::buffers_suffix<Buffers>;
  Left left_;  // unwritten part of the piece and of the body
};

class BeastServer final : public Server {
 public:
  BeastServer(LogSink log, std::unique_ptr<Loop> loop) : loop_(std::move(loop)) {
    shared_->log = std::move(log);
    shared_->loop = loop_.get();
  }
  ~BeastServer() override { loop_ready_.release(); }  // the loop owns the descriptor

  Status open(const std::string& address, std::uint16_t first, int ports) {
    beast::error_code error;
    const auto parsed = asio::ip::make_address(address, error);
    if (error) return Error{Code::Invalid, "listen: \"" + address + "\" is not an IP address"};
    for (int i = 0; i < ports; ++i) {
      const tcp::endpoint place(parsed, static_cast<std::uint16_t>(first == 0 ? 0 : first + i));
      acceptor_ = tcp::acceptor(context_);
      error = {};
      acceptor_.open(place.protocol(), error);
      if (!error) acceptor_.set_option(asio::socket_base::reuse_address(true), error);
      if (!error) acceptor_.bind(place, error);
      if (!error) acceptor_.listen(asio::socket_base::max_listen_connections, error);
      if (!error || error != asio::error::address_in_use) break;
    }
    if (error)
      return Error{Code::System,
                   "listen on " + address + ", port " + std::to_string(first) +
                       (ports > 1 ? " to " + std::to_string(first + ports - 1) : std::string()) +
                       ": " + error.message()};
    return {};
  }

  Status use(const std::string& identity) {
    // TLS 1.3 only.
    using Tls = asio::ssl::context;
    secure_.emplace(Tls::tls_server);
    beast::error_code error;
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
  }
  void stop() override {
    loop_->post([this] {
      constexpr std::chrono::milliseconds kMoment{200};
      stop_ =
          loop_->call_at(std::chrono::steady_clock::now() + kMoment, [this] { context_.stop(); });
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
                           [this](beast::error_code error) {
                             if (error) return;
                             turn_loop();  // first, since turn() may throw
                             static_cast<void>(loop_->turn(std::chrono::milliseconds(0)));
                           });
  }

  void accept() {
    acceptor_.async_accept([this](beast::error_code error, tcp::socket socket) {
      if (error) {
        // Usually out of descriptors. If closing a stranger cannot free one, retry later.
        if (error != asio::error::no_descriptors || !Visitor::drop_one(*shared_)) {
          shared_->log(Level::Warning, "server: accept: " + error.message());
          auto timer = std::make_shared<asio::steady_timer>(context_, std::chrono::seconds(1));
          return timer->async_wait([this, timer](beast::error_code) { accept(); });
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
    if (secure_)
      std::make_shared<Connection<Secure>>(Secure(Plain(std::move(socket)), *secure_), visitor)
          ->begin();
    else
      std::make_shared<Connection<Plain>>(Plain(std::move(socket)), visitor)->begin();
  }

  std::shared_ptr<Shared> shared_ = std::make_shared<Shared>();
  std::optional<asio::ssl::context> secure_;
  asio::io_context context_{1};
  tcp::acceptor acceptor_{context_};
  std::unique_ptr<Loop> loop_;
  asio::posix::stream_descriptor loop_ready_{context_, loop_->descriptor()};
  std::list<Loop::Handle> timers_;
  Loop::Handle stop_;
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
