// SPDX-License-Identifier: Apache-2.0
#pragma once
// The conformance suite of all transports. A transport's test tells how to open its ends, and links
// link_conformance.cpp. No sleeps: everything waits for the peer, and the test runner's time-out is
// the watchdog.

#include <gtest/gtest.h>

#include <atomic>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <hc/link/link.h>
#include <hc/os/event.h>
#include <hc/testing/must.h>
#include <hc/testing/next.h>

namespace hc::testing {

/// A transport under test.
struct Transport {
  std::string name;
  /// The URIs of a new link: of its source and of its sink.
  std::function<std::pair<std::string, std::string>()> make;
  bool sink_first = false;  ///< which end must be opened first
  bool ends = true;         ///< the source ends with the sink (listening sources do not)
  /// The source drops messages for a slow reader and limits the rate, as with shm.
  bool drops_at_source = false;
};

inline void PrintTo(const Transport& transport, std::ostream* out) {
  *out << transport.name;
}

/// A URI with more options.
inline std::string with(const std::string& uri, const std::string& options) {
  return uri + (uri.find('?') == std::string::npos ? "?" : "&") + options;
}

/// A descriptor that stops links; it stays raised.
class Stop {
 public:
  void raise() const { event_.raise(); }
  [[nodiscard]] LinkOptions options() const {
    LinkOptions options;
    options.stop = event_.descriptor();
    return options;
  }

 private:
  Event event_ = must(Event::make());
};

/// The log of a link.
struct Warnings {
  std::vector<std::string> lines;
  LinkOptions options() {
    LinkOptions options;
    options.log = [this](Level, std::string_view line) { lines.emplace_back(line); };
    return options;
  }
};

/// Sends a message on another thread, since the sink may wait for its reader; returns it as
/// received.
inline Message carry(Sink& sink, Source& source, const Message& message) {
  std::thread sender([&] { EXPECT_TRUE(sink.send(message)); });
  Message come;
  const auto got = receive(source, come);
  sender.join();
  EXPECT_TRUE(must(got));
  return come;
}

/// A message with `size` bytes of elements, determined by its seq.
inline Message numbered(std::int64_t seq, std::int32_t size) {
  Header header;
  header.info = {MatrixType::IntensityImage, 1, Scalar::U8, Encoding::Binary};
  header.width = size;
  header.height = 1;
  header.seq = seq;
  Draft draft = Draft::make(header);
  for (auto& byte : draft.elements()) byte = static_cast<std::byte>(seq * 7 + size);
  return std::move(draft).finish();
}

/// Sends messages 0, 1, … on another thread and closes the sink. @param size  of each.
inline std::thread send_all(Sink& sink, int count, std::function<std::int32_t(int)> size) {
  return std::thread([&sink, count, size = std::move(size)] {
    for (int i = 0; i < count; ++i) ASSERT_TRUE(sink.send(numbered(i, size(i))));
    ASSERT_TRUE(sink.close());
  });
}
inline std::thread send_all(Sink& sink, int count, std::int32_t size) {
  return send_all(sink, count, [size](int) { return size; });
}

// Tests may use only the helpers above, without the suite.
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(LinkConformance);

class LinkConformance : public ::testing::TestWithParam<Transport> {
 protected:
  /// @param options  of the sink. @param pace  options of the end that limits the rate.
  void open(const std::string& options = "", const std::string& pace = "",
            const LinkOptions& of_sink = {}) {
    auto [from, to] = GetParam().make();
    if (!options.empty()) to = with(to, options);
    auto& paced = GetParam().drops_at_source ? from : to;
    if (!pace.empty()) paced = with(paced, pace);
    if (GetParam().sink_first) sink_ = sink_of(to, of_sink);
    source_ = source_of(from);
    if (!GetParam().sink_first) sink_ = sink_of(to, of_sink);
  }

  /// Sends on another thread, receives here, and compares.
  void transfer(int count, std::int32_t size) {
    auto sender = send_all(*sink_, count, size);
    Message message;
    for (int i = 0; i < count; ++i) {
      auto got = receive(*source_, message);
      ASSERT_TRUE(got && *got) << i;
      Message wanted = numbered(i, size);
      ASSERT_EQ(message.header, wanted.header);
      ASSERT_EQ(message.text(), wanted.text());
    }
    sender.join();
    EXPECT_EQ(source_->traffic().messages, static_cast<std::uint64_t>(count));
    EXPECT_EQ(sink_->traffic().messages, static_cast<std::uint64_t>(count));
    if (!GetParam().ends) return;
    EXPECT_FALSE(must(receive(*source_, message)));
  }

  /// The losses of both ends; its other counters are meaningless.
  [[nodiscard]] Traffic losses() const {
    Traffic both = sink_->traffic();
    both += source_->traffic();
    return both;
  }

  /// Sends without a reading source until messages must have been lost; returns their number.
  std::int64_t send_too_many(std::int32_t size) {
    constexpr std::int64_t kPlenty = 500;  // exceeds `keep` and `memory`
    std::int64_t count = 0;
    while (GetParam().drops_at_source ? count < kPlenty : losses().lost() < 10)
      EXPECT_TRUE(sink_->send(numbered(count++, size)));
    return count;
  }

  /// Closes the sink, receives up to message `last`, and checks the order and that lost messages
  /// were counted. Returns the number received.
  std::uint64_t take_to(std::int64_t last) {
    std::thread closer([&] { ASSERT_TRUE(sink_->close()); });
    Message message;
    std::uint64_t received = 0;
    for (std::int64_t seq = -1; seq < last; ++received) {
      auto got = receive(*source_, message);
      if (!got || !*got || message.header.seq <= seq) {
        ADD_FAILURE() << "behind " << seq;
        break;
      }
      seq = message.header.seq;
      EXPECT_EQ(message.text(),
                numbered(seq, static_cast<std::int32_t>(message.elements.size())).text());
    }
    closer.join();
    EXPECT_EQ(sink_->traffic().messages, static_cast<std::uint64_t>(last) + 1);
    EXPECT_EQ(sink_->traffic().messages, received + losses().lost());
    return received;
  }

  std::unique_ptr<Source> source_;
  std::unique_ptr<Sink> sink_;
};

}  // namespace hc::testing
