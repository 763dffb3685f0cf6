// SPDX-License-Identifier: Apache-2.0
// TLS links: the conformance suite, and that of sockets.
#include <hc/testing/socket_link.h>
#include <tls/acceptor.h>
#include <tls/peer_test.h>

namespace hc::testing {
namespace {

/// A plain socket that is relayed to a place over TLS.
Descriptor connect(const std::string& place) {
  static const Context kContext = make_context("b");
  auto socket = connect_plainly(place);
  auto session = shake_hands(kContext.get(), socket);
  EXPECT_TRUE(session) << complaint();
  auto [ours, far] = make_pair();
  if (session) relay(std::move(session), std::move(socket), std::move(far));
  return std::move(ours);
}

/// Both ends have the same two keys, so that each accepts the other.
const SocketScheme& scheme() {
  static const SocketScheme kTls{
      "tls",   free_port,      "tls:",      "tls-listen:",
      connect, tls::find_peer, tls::listen, "?key=" + key_file("b") + "&peer=" + key_file("b"),
      1000};
  return kTls;
}

INSTANTIATE_TEST_SUITE_P(Tls, LinkConformance, ::testing::ValuesIn(both_ways(scheme())));
INSTANTIATE_TEST_SUITE_P(Tls, SocketLink, ::testing::Values(scheme()));

// A key is used for at most 2^12 records.
TEST(Tls, TheKeyIsChangedInTime) {
  constexpr int kCount = 3;
  constexpr std::int32_t kSize = 100 << 20;  // 6,400 records
  const std::string place = free_port() + scheme().options;
  auto source = source_of("tls-listen:" + place);
  std::thread sender([&] {
    auto sink = sink_of("tls:" + place);
    for (int i = 0; i < kCount; ++i) ASSERT_TRUE(sink->send(numbered(i, kSize)));
    ASSERT_TRUE(sink->close());
  });
  for (int i = 0; i < kCount; ++i) {
    ASSERT_EQ(next(*source).elements.back(), static_cast<std::byte>(i * 7 + kSize));
  }
  sender.join();
}

}  // namespace
}  // namespace hc::testing
