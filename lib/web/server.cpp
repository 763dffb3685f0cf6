// SPDX-License-Identifier: Apache-2.0
#include <web/server.h>

#include <algorithm>
#include <array>
#include <deque>
#include <exception>
#include <optional>
#include <set>
#include <type_traits>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/ssl.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/thread_pool.hpp>
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

constexpr std::size_t kMaxHead = 8192, kMaxMessage = 65536, kMaxConnections = 1024;  // [byte], 1
constexpr std::chrono::seconds kHeadTime{5}, kIdleTime{30};
constexpr std::chrono::seconds kPongTime{10};   // of a WebSocket from which nothing comes
constexpr std::chrono::seconds kWriteTime{60};  // of a file

/// What has been escaped by %; nothing where that is wrong or hides a zero byte.
std::optional<std::string> decoded(std::string_view text) {
  std::string plain;
  auto digit = [](char c) {
    return c >= '0' && c <= '9'   ? c - '0'
           : c >= 'a' && c <= 'f' ? c - 'a' + 10
           : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                  : -1;
  };
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '%') {
      plain += text[i];
      continue;
    }
    if (i + 2 >= text.size()) return std::nullopt;
    const int high = digit(text[i + 1]), low = digit(text[i + 2]);
    if (high < 0 || low < 0 || high + low == 0) return std::nullopt;
    plain += static_cast<char>(high * 16 + low);
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

/// What connections share.
struct Shared {
  Site* site = nullptr;
  int connections = 0;
  asio::thread_pool* files = nullptr;  // where those that take long are made
};

/// Counts a connection while it lives.
class Counted {
 public:
  explicit Counted(std::shared_ptr<Shared> shared) : shared_(std::move(shared)) {
    ++shared_->connections;
  }
  Counted(const Counted&) = delete;
  Counted& operator=(const Counted&) = delete;
  ~Counted() { --shared_->connections; }
  [[nodiscard]] Site& site() const { return *shared_->site; }
  [[nodiscard]] asio::thread_pool& files() const { return *shared_->files; }

 private:
  std::shared_ptr<Shared> shared_;
};

/// A WebSocket over a stream of either kind. The page's handlers keep it, and it keeps itself while
/// something is read or written.
template <typename Stream>
class Socket final : public WebSocket, public std::enable_shared_from_this<Socket<Stream>> {
 public:
  Socket(Stream&& stream, std::shared_ptr<Counted> counted)
      : stream_(std::move(stream)), counted_(std::move(counted)) {}

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
    // Little waits in the kernel, so that what is sent is new.
    beast::error_code ignored;
    beast::get_lowest_layer(stream_).socket().set_option(
        asio::socket_base::send_buffer_size(1 << 17), ignored);
    beast::get_lowest_layer(stream_).socket().set_option(tcp::no_delay(true), ignored);
    auto kept = std::make_shared<http::request<http::empty_body>>(std::move(head));
    stream_.async_accept(*kept, [self = this->shared_from_this(), kept,
                                 asked = std::move(request)](beast::error_code error) {
      if (error) return;
      self->counted_->site().open(self, asked);
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
                          if (const auto sent = self->on_sent) sent();
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
          if (handler) handler(text);
          self->buffer_.consume(self->buffer_.size());
          self->read();
        });
  }

  void lose() {
    const auto closed = on_close;
    forget();
    if (closed) closed();
  }
  void forget() { on_text = on_binary = nullptr, on_sent = on_close = nullptr; }

  websocket::stream<Stream> stream_;
  std::shared_ptr<Counted> counted_;
  beast::flat_buffer buffer_;
  std::deque<Outgoing> queue_;  // the first is being written
  bool is_writing_ = false;
  std::optional<std::pair<std::uint16_t, std::string>> closing_;
};

/// A connection that speaks HTTP.
template <typename Stream>
class Connection : public std::enable_shared_from_this<Connection<Stream>> {
 public:
  Connection(Stream&& stream, std::shared_ptr<Counted> counted)
      : stream_(std::move(stream)), counted_(std::move(counted)) {}

  void begin() {
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
      return write({431, "text/plain", text("the request is too large\n"), {}, {}, {}}, false);
    if (error == beast::error::timeout || error == http::error::end_of_stream) return;
    if (error.category() == http::make_error_code(http::error::bad_line_ending).category())
      return write({400, "text/plain", text("no request of HTTP\n"), {}, {}, {}}, false);
    if (error) return;
    auto head = parser_->release();
    auto request = request_of(head);
    if (!request)
      return write({400, "text/plain", text("the path is malformed\n"), {}, {}, {}}, false);
    if (head.method() != http::verb::get)
      return write({405, "text/plain", text("only GET is served\n"), {}, {}, {}}, false);
    const bool keeps = head.keep_alive() && !request->is_socket;
    Reply reply = counted_->site().reply(*request);
    if (reply.status != 101) return write(std::move(reply), keeps);
    std::make_shared<Socket<Stream>>(std::move(stream_), counted_)
        ->accept(std::move(head), std::move(*request), reply);
  }

  static Bytes text(const char* words) { return std::make_shared<const std::string>(words); }

  template <typename Response>
  void set_head(Response& response, const Reply& reply, bool keeps) {
    response.version(11);
    response.result(static_cast<unsigned>(reply.status));
    response.set(http::field::content_type, reply.type);
    response.set("X-Content-Type-Options", "nosniff");
    response.set("Referrer-Policy", "no-referrer");
    response.set("Cross-Origin-Opener-Policy", "same-origin");
    response.set("Cross-Origin-Resource-Policy", "same-origin");
    for (const auto& [name, value] : reply.fields) response.set(name, value);
    response.keep_alive(keeps);
    response.prepare_payload();
  }

  template <typename Response>
  void send(std::shared_ptr<Response> response, bool keeps, std::chrono::seconds time) {
    beast::get_lowest_layer(stream_).expires_after(time);
    http::async_write(
        stream_, *response,
        [self = this->shared_from_this(), response, keeps](beast::error_code error, std::size_t) {
          if (error) return;
          if (keeps) return self->read();
          self->end();
        });
  }

  /// Has the file of a reply made elsewhere, and sends it then.
  void make(Reply reply, bool keeps) {
    beast::get_lowest_layer(stream_).expires_never();
    asio::post(counted_->files(), [self = this->shared_from_this(), reply = std::move(reply),
                                   keeps] {
      auto path = reply.make_file();
      asio::post(self->stream_.get_executor(), [self, reply, keeps,
                                                path = std::move(path)]() mutable {
        reply.make_file = nullptr;
        if (path) reply.file = *path;
        if (!path)
          reply = {
              404, "text/plain", std::make_shared<const std::string>(path.error().detail + "\n"),
              {},  {},           {}};
        self->write(std::move(reply), keeps);
      });
    });
  }

  void write(Reply reply, bool keeps) {
    if (reply.make_file) return make(std::move(reply), keeps);
    if (!reply.file.empty()) {
      auto response = std::make_shared<http::response<http::file_body>>();
      beast::error_code error;
      response->body().open(reply.file.c_str(), beast::file_mode::scan, error);
      if (error)
        return write({404, "text/plain", text("there is no such file\n"), {}, {}, {}}, keeps);
      set_head(*response, reply, keeps);
      return send(response, keeps, kWriteTime);
    }
    // The body is shared by all pages, and not copied.
    auto response = std::make_shared<http::response<http::span_body<const char>>>();
    if (reply.body) response->body() = {reply.body->data(), reply.body->size()};
    bodies_ = reply.body;
    set_head(*response, reply, keeps);
    send(response, keeps, kIdleTime);
  }

  void end() {
    beast::error_code ignored;
    beast::get_lowest_layer(stream_).socket().shutdown(tcp::socket::shutdown_send, ignored);
  }

  Stream stream_;
  std::shared_ptr<Counted> counted_;
  beast::flat_buffer buffer_{kMaxHead};
  std::optional<http::request_parser<http::empty_body>> parser_;
  Bytes bodies_;  // of the reply that is being written
};

class BeastServer final : public Server {
 public:
  explicit BeastServer(LogSink log) : log_(std::move(log)) {}

  Status open(const std::string& address, std::uint16_t first, int ports) {
    beast::error_code error;
    const auto parsed = asio::ip::make_address(address, error);
    if (error) return Error{Code::Invalid, "listen: \"" + address + "\" is no IP address"};
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

  Status use(const Identity& identity) {
    // TLS 1.3 alone.
    using Tls = asio::ssl::context;
    secure_.emplace(Tls::tls_server);
    beast::error_code error;
    secure_->set_options(Tls::default_workarounds | Tls::no_sslv2 | Tls::no_sslv3 | Tls::no_tlsv1 |
                             Tls::no_tlsv1_1 | Tls::no_tlsv1_2,
                         error);
    if (!error) secure_->use_certificate_chain(asio::buffer(identity.certificate), error);
    if (!error) secure_->use_private_key(asio::buffer(identity.key), Tls::pem, error);
    if (error) return Error{Code::System, "certificate: " + error.message()};
    return {};
  }

  [[nodiscard]] std::uint16_t port() const override { return acceptor_.local_endpoint().port(); }

  void run(Site& site) override {
    shared_->site = &site;
    shared_->files = &files_;
    accept();
    while (true) {
      try {
        context_.run();
        return;
      } catch (const std::exception& error) {  // of a Site; the others are served on
        log_(Severity::Error, std::string("server: ") + error.what());
      }
    }
  }
  void stop() override {
    asio::post(context_, [this] {
      constexpr std::chrono::milliseconds kMoment{200};
      auto timer = std::make_shared<asio::steady_timer>(context_, kMoment);
      timer->async_wait([this, timer](beast::error_code) { context_.stop(); });
    });
  }
  void post(std::function<void()> call) override { asio::post(context_, std::move(call)); }

  void every(std::chrono::milliseconds period, std::function<void()> call) override {
    auto timer = std::make_shared<asio::steady_timer>(context_);
    auto next = std::make_shared<std::function<void()>>();
    *next = [timer, period, call = std::move(call), weak = std::weak_ptr(next)] {
      timer->expires_after(period);
      timer->async_wait([call, again = weak.lock()](beast::error_code error) {
        if (error || !again) return;
        call();
        (*again)();
      });
    };
    asio::post(context_, [next] { (*next)(); });
  }

 private:
  void accept() {
    acceptor_.async_accept([this](beast::error_code error, tcp::socket socket) {
      if (error) {
        // No descriptors are left, as a rule: the next attempt is not to be at once.
        log_(Severity::Warning, "server: accept: " + error.message());
        auto timer = std::make_shared<asio::steady_timer>(context_, std::chrono::seconds(1));
        return timer->async_wait([this, timer](beast::error_code) { accept(); });
      }
      if (shared_->connections < static_cast<int>(kMaxConnections)) begin(std::move(socket));
      accept();
    });
  }

  void begin(tcp::socket socket) {
    auto counted = std::make_shared<Counted>(shared_);
    if (secure_)
      std::make_shared<Connection<Secure>>(Secure(Plain(std::move(socket)), *secure_), counted)
          ->begin();
    else
      std::make_shared<Connection<Plain>>(Plain(std::move(socket)), counted)->begin();
  }

  LogSink log_;
  std::shared_ptr<Shared> shared_ = std::make_shared<Shared>();
  std::optional<asio::ssl::context> secure_;
  asio::io_context context_{1};
  tcp::acceptor acceptor_{context_};
  asio::thread_pool files_{1};  // last: what it makes is posted to the above
};

}  // namespace

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
                                               int ports, const Identity* identity, LogSink log) {
  auto server = std::make_unique<BeastServer>(std::move(log));
  if (auto opened = server->open(address, port, ports); !opened) return opened.error();
  if (identity != nullptr)
    if (auto used = server->use(*identity); !used) return used.error();
  return std::unique_ptr<Server>(std::move(server));
}

}  // namespace hc::web
