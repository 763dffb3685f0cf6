// SPDX-License-Identifier: Apache-2.0
#include <web/connection.h>

#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

#include <boost/asio/ssl.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket/rfc6455.hpp>

#include <web/web_socket.h>

namespace hc::web {

namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using tcp = asio::ip::tcp;

constexpr std::size_t kMaxHead = 8192;  // [byte]
constexpr std::size_t kPiece = 262144;  // for reading files [byte]
constexpr std::chrono::seconds kIdleTime{30};

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
  request.is_socket = beast::websocket::is_upgrade(head);
  return request;
}

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
    if (error || visitor_->shared().is_ending) return;
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
    accept_web_socket(std::move(stream_), visitor_, std::move(head), std::move(*request), reply);
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

}  // namespace

void serve(tcp::socket socket, asio::ssl::context* tls, std::shared_ptr<Visitor> visitor) {
  Plain stream(std::move(socket));
  if (tls != nullptr)
    std::make_shared<Connection<Secure>>(Secure(std::move(stream), *tls), std::move(visitor))
        ->begin();
  else
    std::make_shared<Connection<Plain>>(std::move(stream), std::move(visitor))->begin();
}

}  // namespace hc::web
