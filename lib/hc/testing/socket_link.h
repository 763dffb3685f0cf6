// SPDX-License-Identifier: Apache-2.0
#pragma once
// Tests of tcp and unix links beyond the conformance suite: listening, refusing, reconnecting.
// They are in socket_link.cpp and reconnect.cpp.

#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include <filesystem>
#include <functional>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include <hc/link/stream/ends.h>
#include <hc/link/stream/source.h>
#include <hc/mtp/codec.h>
#include <hc/os/descriptor.h>
#include <hc/os/reactor.h>
#include <hc/testing/link_conformance.h>
#include <hc/testing/loopback.h>

namespace hc::testing {

/// A scheme of links over sockets.
struct SocketScheme {
  std::string name;
  std::function<std::string()> place;  ///< unused: "localhost:7000", "/tmp/x"
  std::string dial, listen;            ///< schemes
  /// A stream socket connected to a place, for data that no link would send.
  std::function<Descriptor(const std::string& place)> connect;
  /// The transports of the two schemes.
  std::function<Result<internal::Peer>(const Uri&)> peer = {};
  std::function<Result<ListeningSocket>(const Uri&, const LogSink&)> socket = {};
  std::string options = {};  ///< of every end, such as "?key=eyes.pem"
  int cuts = 10'000;         ///< number of truncated streams to test
};

inline void PrintTo(const SocketScheme& scheme, std::ostream* out) {
  *out << scheme.name;
}

/// Both directions as transports of the conformance suite.
inline std::vector<Transport> both_ways(const SocketScheme& scheme) {
  auto source_listens = [scheme] {
    std::string place = scheme.place() + scheme.options;
    return std::pair{scheme.listen + place, scheme.dial + place};
  };
  auto sink_listens = [scheme] {
    std::string place = scheme.place() + scheme.options;
    return std::pair{scheme.dial + place, with(scheme.listen + place, "readers=1")};
  };
  return {{scheme.name + "_source_listens", source_listens, false, false},
          {scheme.name + "_sink_listens", sink_listens, true, true}};
}

/// Calls take() on a source that gets no message until it has logged something.
inline void await_warning(Source& source, const Warnings& warnings) {
  Message message;
  while (warnings.lines.empty()) {
    ASSERT_EQ(must(source.take(message)), Got::Nothing);
    if (warnings.lines.empty()) must(source.wait());
  }
}

/// Writes data that no link would send.
inline void write_to(const Descriptor& peer, std::string_view bytes) {
  ASSERT_EQ(::write(peer.get(), bytes.data(), bytes.size()), static_cast<ssize_t>(bytes.size()));
}
inline bool is_closed(const Descriptor& peer) {
  char byte = 0;
  return ::read(peer.get(), &byte, 1) <= 0;
}

// Tests may use only the helpers above, without the suite.
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(SocketLink);

class SocketLink : public ::testing::TestWithParam<SocketScheme> {
 protected:
  void SetUp() override { place_ = GetParam().place(); }
  [[nodiscard]] std::string dial() const { return GetParam().dial + place_ + GetParam().options; }
  [[nodiscard]] std::string listen() const {
    return GetParam().listen + place_ + GetParam().options;
  }
  /// Opens a listening source with these time-outs for its peers.
  [[nodiscard]] std::unique_ptr<Source> source_with(internal::PeerTimes times,
                                                    Warnings& warnings) const {
    return must(internal::listening_source(*GetParam().socket(*parse_uri(listen()), {}),
                                           warnings.options(), times));
  }
  std::string place_;
};

/// Links that accept on the thread that uses them.
class AcceptingLink : public SocketLink {};
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(AcceptingLink);

/// The number of open descriptors of this process.
inline std::size_t open_descriptors() {
  std::size_t count = 0;
  for ([[maybe_unused]] const auto& each : std::filesystem::directory_iterator("/proc/self/fd"))
    ++count;
  return count;
}

}  // namespace hc::testing
