// SPDX-License-Identifier: Apache-2.0
#include <tls/channel.h>

#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>

#include <openssl/bio.h>
#include <openssl/err.h>

#include <hc/base/check.h>

namespace hc::tls {
namespace {

constexpr std::size_t kRecordBytes = SSL3_RT_MAX_PLAIN_LENGTH;
/// Records written before the key is updated. AES-GCM allows 2^24.5 (RFC 8446, 5.5).
constexpr std::uint64_t kRecordsOfAKey = 1 << 12;
/// Limit on replies kept for a peer that makes us answer but does not read.
constexpr std::size_t kMostUnsent = 256 << 10;

int write_bytes(BIO* bio, const char* data, int size) {
  auto* channel = static_cast<TlsChannel*>(BIO_get_data(bio));
  BIO_clear_retry_flags(bio);
  const int sent = channel->send(std::span(data, static_cast<std::size_t>(size)));
  if (sent < 0 && errno == EAGAIN) BIO_set_retry_write(bio);
  return sent;
}

long control(BIO*, int command, long, void*) {
  return command == BIO_CTRL_FLUSH ? 1 : 0;
}

/// A BIO that passes OpenSSL's encrypted output to the channel.
BIO* make_writing_end(TlsChannel* channel) {
  static BIO_METHOD* const kMethod = [] {
    auto* method = BIO_meth_new(BIO_get_new_index() | BIO_TYPE_SOURCE_SINK, "hypercolumn");
    BIO_meth_set_write(method, write_bytes);
    BIO_meth_set_ctrl(method, control);
    return method;
  }();
  BIO* bio = BIO_new(kMethod);
  HC_CHECK(bio != nullptr);
  BIO_set_data(bio, channel);
  BIO_set_init(bio, 1);
  return bio;
}

/// OpenSSL's errors when the peer has refused our key, and when it does not speak TLS.
constexpr int kRefusals[] = {
    SSL_R_SSLV3_ALERT_BAD_CERTIFICATE,      SSL_R_SSLV3_ALERT_CERTIFICATE_UNKNOWN,
    SSL_R_SSLV3_ALERT_HANDSHAKE_FAILURE,    SSL_R_SSLV3_ALERT_UNSUPPORTED_CERTIFICATE,
    SSL_R_TLSV1_ALERT_ACCESS_DENIED,        SSL_R_TLSV1_ALERT_UNKNOWN_CA,
    SSL_R_TLSV13_ALERT_CERTIFICATE_REQUIRED};
constexpr int kNotTls[] = {SSL_R_WRONG_VERSION_NUMBER,     SSL_R_HTTP_REQUEST,
                           SSL_R_HTTPS_PROXY_REQUEST,      SSL_R_BAD_RECORD_TYPE,
                           SSL_R_RECORD_LENGTH_MISMATCH,   SSL_R_PACKET_LENGTH_TOO_LONG,
                           SSL_R_ENCRYPTED_LENGTH_TOO_LONG};

}  // namespace

TlsChannel::TlsChannel(std::shared_ptr<const Context> context, int socket, Side side)
    : context_(std::move(context)), socket_(socket), side_(side), ssl_(SSL_new(context_->get())) {
  HC_CHECK(ssl_ != nullptr);
  SSL_set_app_data(ssl_.get(), this);
  BIO* reading_end = BIO_new_socket(socket, BIO_NOCLOSE);
  HC_CHECK(reading_end != nullptr);
  SSL_set0_rbio(ssl_.get(), reading_end);
  SSL_set0_wbio(ssl_.get(), make_writing_end(this));
  // SSL_peek_ex() shall return after the server's ticket, before any data that follows it.
  SSL_clear_mode(ssl_.get(), SSL_MODE_AUTO_RETRY);
  if (side == Side::Dials)
    SSL_set_connect_state(ssl_.get());
  else
    SSL_set_accept_state(ssl_.get());
}

TlsChannel::~TlsChannel() {
  end();
}

TlsChannel& TlsChannel::of(const SSL* ssl) {
  return *static_cast<TlsChannel*>(SSL_get_app_data(ssl));
}

Result<short> TlsChannel::agree() {
  ERR_clear_error();
  if (state_ == State::Handshaking) {
    const int done = SSL_do_handshake(ssl_.get());
    if (done != 1) return awaited(done);
    state_ = State::AwaitingTicket;
  }
  if (state_ == State::AwaitingTicket) {
    char byte = 0;
    std::size_t size = 0;
    if (side_ == Side::Dials && !is_confirmed_) {
      const int got = SSL_peek_ex(ssl_.get(), &byte, 1, &size);
      if (!is_confirmed_) {
        if (got == 1) fail(got);  // data before the ticket
        return awaited(got);
      }
    }
    SSL_set_mode(ssl_.get(), SSL_MODE_AUTO_RETRY);
    SSL_set_read_ahead(ssl_.get(), 1);  // only now, so that no data has been read yet
    state_ = State::Open;
  }
  if (failure_) return *failure_;
  return static_cast<short>(0);
}

/// The poll events that the handshake waits for, or the reason why it failed.
Result<short> TlsChannel::awaited(int result) {
  const int error = SSL_get_error(ssl_.get(), result);
  if (error != SSL_ERROR_WANT_READ && error != SSL_ERROR_WANT_WRITE) fail(result);
  static_cast<void>(flush());
  if (failure_) return *failure_;
  return static_cast<short>(has_unsent() ? POLLIN | POLLOUT : POLLIN);
}

std::string TlsChannel::why_refused(int result) const {
  const int reason = ERR_GET_REASON(ERR_peek_error());
  const bool is_silent = ERR_peek_error() == 0;
  if (refused_key_ && !refused_key_->empty())
    return "the peer's key is " + *refused_key_ + ", not one of peer=";
  if (reason == SSL_R_PEER_DID_NOT_RETURN_A_CERTIFICATE) return "the peer has sent no key";
  if (std::ranges::count(kRefusals, reason) > 0)
    return "the peer has refused our key; add it to the peer's peer=";
  if (reason == SSL_R_UNSUPPORTED_PROTOCOL || reason == SSL_R_TLSV1_ALERT_PROTOCOL_VERSION)
    return "the peer does not support TLS 1.3";
  if (std::ranges::count(kNotTls, reason) > 0) return "the peer does not speak TLS";
  if (is_silent || reason == SSL_R_UNEXPECTED_EOF_WHILE_READING ||
      SSL_get_error(ssl_.get(), result) == SSL_ERROR_ZERO_RETURN)
    return "the peer disconnected during the TLS handshake; is it a tls-listen link?";
  const char* text = ERR_reason_error_string(ERR_peek_error());
  return std::string("the TLS handshake failed: ") + (text != nullptr ? text : "unknown error");
}

void TlsChannel::fail(int result) {
  if (failure_) return;
  if (state_ != State::Open) {
    failure_ = Error{Code::Closed, why_refused(result)};
  } else if (send_errno_ != 0) {
    failure_ = system_error("write", "", send_errno_);
  } else if (const auto error = ERR_peek_error();
             error == 0 || ERR_GET_REASON(error) == SSL_R_UNEXPECTED_EOF_WHILE_READING) {
    failure_ = Error{Code::Closed, "the peer vanished"};
  } else {
    const char* text = ERR_reason_error_string(error);
    failure_ = Error{Code::Closed,
                     std::string("TLS failed: ") + (text != nullptr ? text : "unknown error")};
  }
  state_ = State::Failed;
}

ssize_t TlsChannel::read(std::span<std::byte> space) {
  ERR_clear_error();
  std::size_t size = 0;
  errno = 0;
  const int got = failure_ ? 0 : SSL_read_ex(ssl_.get(), space.data(), space.size(), &size);
  if (got == 1) return static_cast<ssize_t>(size);
  const int error = failure_ ? SSL_ERROR_SSL : SSL_get_error(ssl_.get(), got);
  const int number = errno;
  if (error == SSL_ERROR_ZERO_RETURN) return 0;
  if (error == SSL_ERROR_WANT_READ || error == SSL_ERROR_WANT_WRITE) {
    static_cast<void>(flush());
    errno = EAGAIN;
    return -1;
  }
  if (error == SSL_ERROR_SYSCALL && number != 0 && !failure_) {
    failure_ = number == ECONNRESET ? Error{Code::Closed, "the peer vanished"}
                                    : system_error("read", "", number);
    state_ = State::Failed;
  }
  fail(got);
  errno = EPROTO;
  return -1;
}

/// The data of the next record: in place if a part fills it, else gathered.
std::span<const std::byte> TlsChannel::next_record(std::span<const iovec> parts, std::size_t skip) {
  record_.clear();
  for (std::size_t i = 0; i < parts.size(); ++i) {
    std::span part(static_cast<const std::byte*>(parts[i].iov_base), parts[i].iov_len);
    part = part.subspan(std::min(skip, part.size()));
    skip -= std::min(skip, parts[i].iov_len);
    const bool is_last = i + 1 == parts.size();
    if (record_.empty() && (part.size() >= kRecordBytes || (is_last && !part.empty())))
      return part.first(std::min(part.size(), kRecordBytes));
    part = part.first(std::min(part.size(), kRecordBytes - record_.size()));
    record_.insert(record_.end(), part.begin(), part.end());
    if (record_.size() == kRecordBytes) break;
  }
  return record_;
}

ssize_t TlsChannel::write(std::span<const iovec> parts) {
  ERR_clear_error();
  std::size_t total = 0;
  while (!failure_ && flush()) {
    const auto record = next_record(parts, total);
    if (record.empty()) return static_cast<ssize_t>(total);
    if (++records_ % kRecordsOfAKey == 0) SSL_key_update(ssl_.get(), SSL_KEY_UPDATE_NOT_REQUESTED);
    std::size_t size = 0;
    const int written = SSL_write_ex(ssl_.get(), record.data(), record.size(), &size);
    if (written != 1) {
      fail(written);
      break;
    }
    total += size;
  }
  if (total > 0) return static_cast<ssize_t>(total);
  if (send_errno_ != 0) fail(-1);
  errno = failure_ ? EPROTO : EAGAIN;
  return -1;
}

int TlsChannel::send(std::span<const char> bytes) {
  if (send_errno_ != 0 || unsent_.size() - sent_ > kMostUnsent) {
    errno = send_errno_ != 0 ? send_errno_ : EAGAIN;
    return -1;
  }
  std::size_t sent = 0;
  // A server's last handshake record is held back; after agree(), write() sends it when the link is
  // ready for the client.
  const bool is_held = side_ == Side::Listens && state_ == State::Handshaking;
  if (!is_held && !has_unsent()) {
    const auto size = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    if (size < 0 && errno != EAGAIN && errno != EWOULDBLOCK && errno != EINTR) {
      send_errno_ = errno;
      return -1;
    }
    sent = static_cast<std::size_t>(std::max<ssize_t>(size, 0));
  }
  unsent_.insert(unsent_.end(), bytes.begin() + static_cast<std::ptrdiff_t>(sent), bytes.end());
  return static_cast<int>(bytes.size());
}

/// Sends pending bytes; returns whether all were sent.
bool TlsChannel::flush() {
  while (has_unsent() && send_errno_ == 0) {
    const auto size = ::send(socket_, unsent_.data() + sent_, unsent_.size() - sent_,
                             MSG_NOSIGNAL | MSG_DONTWAIT);
    if (size >= 0) {
      sent_ += static_cast<std::size_t>(size);
    } else if (errno == EAGAIN || errno == EWOULDBLOCK) {
      return false;
    } else if (errno != EINTR) {
      send_errno_ = errno;
    }
  }
  if (send_errno_ != 0) return false;
  unsent_.clear();
  sent_ = 0;
  return true;
}

bool TlsChannel::has_unread() const {
  return SSL_has_pending(ssl_.get()) == 1;
}

void TlsChannel::end() {
  if (state_ != State::Open || std::exchange(has_ended_, true)) return;
  ERR_clear_error();
  SSL_shutdown(ssl_.get());
  static_cast<void>(flush());
}

}  // namespace hc::tls
