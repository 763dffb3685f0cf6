// SPDX-License-Identifier: Apache-2.0
// Peers that a TLS link refuses: each is logged in one line and receives no data.
#include <sys/stat.h>

#include <hc/mtp/codec.h>
#include <hc/testing/socket_link.h>
#include <tls/acceptor.h>
#include <tls/peer_test.h>

namespace hc::testing {
namespace {

/// A listening source with key a, which accepts key b.
class TlsRefusal : public ::testing::Test {
 protected:
  /// The reason in the next log line, without the URI and the peer's address.
  std::string await_line() {
    const auto before = warnings_.lines.size();
    Message message;
    while (warnings_.lines.size() == before) {
      EXPECT_TRUE(source_->wait());
      EXPECT_EQ(*source_->take(message), Got::Nothing);
    }
    EXPECT_EQ(warnings_.lines.size(), before + 1);
    std::string line = warnings_.lines.back();
    const std::string begin = uri_ + ": refused 127.0.0.1 port ";
    EXPECT_TRUE(line.starts_with(begin)) << line;
    return line.substr(std::min(line.size(), line.find(": ", begin.size()) + 2));
  }

  /// After a refusal, an accepted peer can still connect.
  void serves_others() {
    auto sink = sink_of("tls:" + place_ + options("b", "a"));
    ASSERT_TRUE(sink->send(numbered(7, 10)));
    EXPECT_EQ(next(*source_).header.seq, 7);
    EXPECT_EQ(source_->traffic().messages, 1U);
  }

  const std::string place_ = free_port(), uri_ = "tls-listen:" + place_ + options("a", "b");
  Warnings warnings_;
  std::unique_ptr<Source> source_ = source_of(uri_, warnings_.options());
};

/// The error of opening a link.
std::string refusal(const std::string& uri) {
  auto source = open_source(*parse_uri(uri));
  EXPECT_FALSE(source);
  return source ? "" : source.error().text();
}

TEST_F(TlsRefusal, NoKey) {
  auto socket = connect_plainly(place_);
  const auto context = make_context("");
  EXPECT_FALSE(shake_hands(context.get(), socket));
  EXPECT_EQ(complaint(), "tlsv13 alert certificate required");
  EXPECT_EQ(await_line(), "the peer has sent no key");
  serves_others();
}

TEST_F(TlsRefusal, TheWrongKey) {
  const auto uri = *parse_uri("tls:" + place_ + options("c", "a"));
  const std::string line =
      "the peer's key is " + *tls::fingerprint_of(key_file("c")) + ", not one of peer=";
  const std::string why =
      "Closed: connect(" + place_ + "): the peer has refused our key; add it to the peer's peer=";
  EXPECT_EQ(refused(open_source(uri)).text(), why);
  EXPECT_EQ(await_line(), line);
  EXPECT_EQ(refused(open_sink(uri)).text(), why);  // before anything is sent
  EXPECT_EQ(await_line(), line);
  serves_others();
}

TEST_F(TlsRefusal, AListenerWithTheWrongKey) {
  EXPECT_EQ(refusal("tls:" + place_ + options("b", "c")),
            "Closed: connect(" + place_ + "): the peer's key is " +
                *tls::fingerprint_of(key_file("a")) + ", not one of peer=");
  EXPECT_EQ(await_line(), "the peer has refused our key; add it to the peer's peer=");
  serves_others();
}

TEST_F(TlsRefusal, Tls12) {
  auto socket = connect_plainly(place_);
  const auto context = make_context("b");
  SSL_CTX_set_max_proto_version(context.get(), TLS1_2_VERSION);
  EXPECT_FALSE(shake_hands(context.get(), socket));
  EXPECT_EQ(complaint(), "tlsv1 alert protocol version");
  EXPECT_EQ(await_line(), "the peer does not support TLS 1.3");
  serves_others();
}

TEST_F(TlsRefusal, PlainText) {
  for (std::string bytes : {encode(numbered(1, 100)), std::string("GET / HTTP/1.1\r\n\r\n")}) {
    auto socket = connect_plainly(place_);
    ASSERT_EQ(::send(socket.get(), bytes.data(), bytes.size(), 0),
              static_cast<ssize_t>(bytes.size()));
    EXPECT_EQ(await_line(), "the peer does not speak TLS");
  }
  serves_others();
}

TEST_F(TlsRefusal, APlainClientThatLeaves) {
  connect_plainly(place_).reset();
  EXPECT_EQ(await_line(),
            "the peer disconnected during the TLS handshake; is it a tls-listen link?");
  serves_others();
}

TEST_F(TlsRefusal, AClientThatSaysNothing) {
  auto socket = connect_plainly(place_);
  EXPECT_EQ(await_line(), "no TLS handshake within 4 s");
  char byte = 0;
  EXPECT_EQ(::recv(socket.get(), &byte, 1, 0), 0);
  serves_others();
}

// The sink of a plain link sends at once, whatever the peer is.
TEST_F(TlsRefusal, APlainLinkAtATlsPort) {
  auto sink = sink_of("tcp:" + place_);
  Status sent;
  while (sent) sent = sink->send(numbered(1, 100));
  EXPECT_EQ(sent.error().code, Code::Closed);
  EXPECT_EQ(await_line(), "the peer does not speak TLS");
  serves_others();
}

TEST(Tls, AtAPlainPort) {
  const std::string place = free_port();
  Warnings warnings;
  auto source = source_of("tcp-listen:" + place, warnings.options());
  std::string why;
  std::thread client([&] { why = refusal("tls:" + place + options("a", "b")); });
  await_warning(*source, warnings);
  client.join();
  EXPECT_EQ(why, "Closed: connect(" + place +
                     "): the peer disconnected during the TLS handshake; is it a "
                     "tls-listen link?");
  EXPECT_NE(warnings.lines[0].find("closed a connection: Malformed: R5"), std::string::npos)
      << warnings.lines[0];
}

// Their number is bounded, and other peers are served.
TEST_F(TlsRefusal, AThousandThatStartAndSayNoMore) {
  constexpr std::size_t kCount = 1000;
  const auto before = open_descriptors();
  std::vector<Descriptor> sockets;
  constexpr char kBegin[] = {22, 3, 1, 2};  // start of a client's first record
  for (std::size_t i = 0; i < kCount; ++i) {
    sockets.push_back(connect_plainly(place_));
    ASSERT_EQ(::send(sockets.back().get(), kBegin, sizeof kBegin, MSG_NOSIGNAL), 4);
  }
  serves_others();
  EXPECT_LE(open_descriptors(), before + kCount + tls::Acceptor::kMaxHandshakes + 10);
  ASSERT_EQ(warnings_.lines.size(), 1U);
  EXPECT_EQ(warnings_.lines[0],
            uri_ + ": more than 256 peers are in a TLS handshake; closing the oldest of them");
}

// A relay with its own key between two ends that accept each other's.
TEST_F(TlsRefusal, AManInTheMiddle) {
  const auto listening = *listen_on(loopback_address(0), "relay");
  sockaddr_in address{};
  socklen_t size = sizeof address;
  ASSERT_EQ(::getsockname(listening.get(), reinterpret_cast<sockaddr*>(&address), &size), 0);
  const std::string middle = "127.0.0.1:" + std::to_string(ntohs(address.sin_port));
  std::string why;
  std::thread client([&] { why = refusal("tls:" + middle + options("b", "a")); });

  pollfd polled{listening.get(), POLLIN, 0};
  ASSERT_EQ(::poll(&polled, 1, -1), 1);
  const Descriptor accepted(::accept4(listening.get(), nullptr, nullptr, SOCK_CLOEXEC));
  const auto context = make_context("c");
  const Session session(SSL_new(context.get()));
  SSL_set_fd(session.get(), accepted.get());
  char byte = 0;
  EXPECT_FALSE(SSL_accept(session.get()) == 1 && SSL_read(session.get(), &byte, 1) == 1);
  client.join();
  const std::string wrong =
      "the peer's key is " + *tls::fingerprint_of(key_file("c")) + ", not one of peer=";
  EXPECT_EQ(why, "Closed: connect(" + middle + "): " + wrong);

  const auto onward = connect_plainly(place_);
  EXPECT_FALSE(shake_hands(context.get(), onward));
  EXPECT_EQ(await_line(), wrong);
  serves_others();
}

// Modified data, and an end without close_notify, are not taken for the end of the stream.
TEST_F(TlsRefusal, AConnectionThatIsCut) {
  const auto context = make_context("b");
  auto socket = connect_plainly(place_);
  auto session = shake_hands(context.get(), socket);
  ASSERT_TRUE(session);
  const std::string bytes = encode(numbered(3, 10));
  ASSERT_GT(SSL_write(session.get(), bytes.data(), static_cast<int>(bytes.size())), 0);
  next(*source_);
  socket.reset();
  await_warning(*source_, warnings_);
  EXPECT_EQ(warnings_.lines[0], uri_ + ": closed a connection: the peer vanished");
}

TEST_F(TlsRefusal, BytesThatAreNotFromThePeer) {
  const auto context = make_context("b");
  auto socket = connect_plainly(place_);
  ASSERT_TRUE(shake_hands(context.get(), socket));
  constexpr char kForged[] = {23, 3, 3, 0, 32};
  std::string record(kForged, sizeof kForged);
  record.resize(sizeof kForged + 32, 'x');
  ASSERT_EQ(::send(socket.get(), record.data(), record.size(), 0),
            static_cast<ssize_t>(record.size()));
  await_warning(*source_, warnings_);
  EXPECT_EQ(warnings_.lines[0],
            uri_ + ": closed a connection: TLS failed: decryption failed or bad record mac");
  serves_others();
}

TEST(TlsKey, IsForItsOwnerAlone) {
  const auto path = key_file("open");
  struct stat status {};
  ASSERT_EQ(::stat(path.c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777U, 0600U);
  const auto key = *tls::fingerprint_of(path);
  EXPECT_TRUE(tls::make_key(path));
  EXPECT_EQ(*tls::fingerprint_of(path), key);
  ASSERT_EQ(::chmod(path.c_str(), 0640), 0);
  EXPECT_EQ(refusal("tls:127.0.0.1:1" + options("open", "a")),
            "Invalid: key " + path + ": other users may read it; chmod 600 it, or make a new one");
}

TEST(TlsKey, OptionsThatMakeNoSenseAreRefused) {
  const std::string place = "tls:127.0.0.1:1";
  const std::string both =
      "tls needs the options key=FILE and peer=FINGERPRINT; hc key FILE makes a key";
  EXPECT_EQ(refusal(place), "Invalid: " + both);
  EXPECT_EQ(check_sink(*parse_uri(place + "?key=a.pem")).error().detail, both);
  EXPECT_TRUE(check_sink(*parse_uri(place + "?key=a.pem&peer=b.pem")));
  EXPECT_EQ(refusal(place + "?key=no.pem&peer=b.pem"),
            "NotFound: open(no.pem): No such file or directory");
  const auto own = "?key=" + key_file("a") + "&peer=";
  EXPECT_EQ(
      refusal(place + own + "beef"),
      "Invalid: peer beef: neither a file nor a fingerprint, which has 64 hexadecimal digits");
  EXPECT_EQ(refusal(place + own + "/dev/null"), "Invalid: peer /dev/null: no certificate in PEM");
}

}  // namespace
}  // namespace hc::testing
