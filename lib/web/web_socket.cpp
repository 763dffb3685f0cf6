// SPDX-License-Identifier: Apache-2.0
#include <web/web_socket.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include <boost/asio/ssl.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>
#include <boost/beast/websocket/ssl.hpp>

namespace hc::web {

namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace websocket = beast::websocket;
using tcp = asio::ip::tcp;

constexpr std::size_t kMaxMessage = 65536;     // [byte]
constexpr std::chrono::seconds kPongTime{10};  // of a silent WebSocket
constexpr int kGoingAway = 1001;               // of RFC 6455

/// A WebSocket over a stream of either kind, kept alive by the page's handlers and by pending I/O.
template <typename Stream>
class Socket final : public WebSocket, public std::enable_shared_from_this<Socket<Stream>> {
 public:
  Socket(Stream&& stream, std::shared_ptr<Visitor> visitor)
      : stream_(std::move(stream)), visitor_(std::move(visitor)) {
    ++visitor_->shared().sockets;
  }
  ~Socket() override { leave(); }

  void accept(Head head, Request request, const Reply& reply) {
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
    auto kept = std::make_shared<Head>(std::move(head));
    stream_.async_accept(*kept, [self = this->shared_from_this(), kept,
                                 asked = std::move(request)](beast::error_code error) {
      if (error) return;
      if (self->visitor_->shared().is_ending) return self->close(kGoingAway, "the server ends");
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
                        [self = this->shared_from_this()](beast::error_code) { self->leave(); });
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
    leave();
    if (closed) visitor_->shared().guard(closed);
  }
  /// No longer counts as an open WebSocket.
  void leave() {
    if (std::exchange(has_left_, true)) return;
    auto& shared = visitor_->shared();
    if (--shared.sockets == 0 && shared.on_last) shared.on_last();
  }
  void forget() { on_text = on_binary = nullptr, on_sent = on_close = nullptr; }

  websocket::stream<Stream> stream_;
  std::shared_ptr<Visitor> visitor_;
  beast::flat_buffer buffer_;
  std::deque<Outgoing> queue_;  // the first is being written
  bool is_writing_ = false, has_left_ = false;
  std::optional<std::pair<std::uint16_t, std::string>> closing_;
};

}  // namespace

void accept_web_socket(Plain stream, std::shared_ptr<Visitor> visitor, Head head, Request request,
                       const Reply& reply) {
  std::make_shared<Socket<Plain>>(std::move(stream), std::move(visitor))
      ->accept(std::move(head), std::move(request), reply);
}

void accept_web_socket(Secure stream, std::shared_ptr<Visitor> visitor, Head head, Request request,
                       const Reply& reply) {
  std::make_shared<Socket<Secure>>(std::move(stream), std::move(visitor))
      ->accept(std::move(head), std::move(request), reply);
}

}  // namespace hc::web
