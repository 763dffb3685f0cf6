// SPDX-License-Identifier: Apache-2.0
#pragma once
// What every transport must do, written once; each transport's test says how its ends are opened,
// and its program has link_conformance.cpp. No sleeps: everything waits for the other side, and the
// test runner's time-out is the watchdog.

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
  /// URIs of a fresh link: where messages come out, and where they go in.
  std::function<std::pair<std::string, std::string>()> make;
  bool sink_first = false;  ///< which end must be opened first
  bool ends = true;         ///< the source ends when the sink closes (one that listens does not)
  /// What a slow reader loses it skips and counts itself, when it comes to it; it keeps the rate.
  bool drops_at_source = false;
};

inline void PrintTo(const Transport& transport, std::ostream* out) {
  *out << transport.name;
}

/// A URI with one more option, or several.
inline std::string with(const std::string& uri, const std::string& options) {
  return uri + (uri.find('?') == std::string::npos ? "?" : "&") + options;
}

/// What asks links to stop, once raised and for ever.
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

/// What a link logged.
struct Warnings {
  std::vector<std::string> lines;
  LinkOptions options() {
    LinkOptions options;
    options.log = [this](Level, std::string_view line) { lines.emplace_back(line); };
    return options;
  }
};

/// Sends a message by another thread, as the sink may wait for its reader; gives what comes.
inline Message carry(Sink& sink, Source& source, const Message& message) {
  std::thread sender([&] { EXPECT_TRUE(sink.send(message)); });
  Message come;
  const auto got = receive(source, come);
  sender.join();
  EXPECT_TRUE(must(got));
  return come;
}

/// A message with `size` bytes of elements that its seq determines.
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

/// Sends messages with this `seq` until a reader that connects meanwhile has received one; its seq.
/// @param source  becomes the reader, and stays connected.
inline std::int64_t first_of_next_reader(Sink& sink, const std::string& uri, std::int64_t seq,
                                         std::unique_ptr<Source>& source) {
  std::atomic<bool> heard = false, done = false;
  std::thread sender([&] {
    while (!heard && sink.send(numbered(seq, 10))) continue;
    done = true;
  });
  source = source_of(uri);
  Message message;
  EXPECT_TRUE(*receive(*source, message));
  const auto first = message.header.seq;
  heard = true;
  while (!done && source->take(message)) continue;
  sender.join();
  return first;
}

/// Sends messages 0, 1, … by another thread, and closes the sink. @param size  of each.
inline std::thread send_all(Sink& sink, int count, std::function<std::int32_t(int)> size) {
  return std::thread([&sink, count, size = std::move(size)] {
    for (int i = 0; i < count; ++i) ASSERT_TRUE(sink.send(numbered(i, size(i))));
    ASSERT_TRUE(sink.close());
  });
}
inline std::thread send_all(Sink& sink, int count, std::int32_t size) {
  return send_all(sink, count, [size](int) { return size; });
}

// Tests that use the helpers above alone need not run the suite.
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(LinkConformance);

class LinkConformance : public ::testing::TestWithParam<Transport> {
 protected:
  /// @param options  of the sink. @param pace  of the end that keeps it.
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

  /// Sends from another thread, takes here, compares.
  void transfer(int count, std::int32_t size) {
    auto sender = send_all(*sink_, count, size);
    Message message;
    for (int i = 0; i < count; ++i) {
      auto got = receive(*source_, message);
      ASSERT_TRUE(got && *got) << i;
      Message wanted = numbered(i, size);
      ASSERT_EQ(message.header, wanted.header);
      ASSERT_EQ(message.characters(), wanted.characters());
    }
    sender.join();
    EXPECT_EQ(source_->traffic().messages, static_cast<std::uint64_t>(count));
    EXPECT_EQ(sink_->traffic().messages, static_cast<std::uint64_t>(count));
    if (!GetParam().ends) return;
    EXPECT_FALSE(must(receive(*source_, message)));
  }

  /// What both ends have lost; of no other use.
  [[nodiscard]] Traffic losses() const {
    Traffic both = sink_->traffic();
    both += source_->traffic();
    return both;
  }

  /// Sends, while nobody reads, until some have been lost for sure; gives how many it sent.
  std::int64_t send_too_many(std::int32_t size) {
    constexpr std::int64_t kPlenty = 500;  // more than are kept, or fit into the memory
    std::int64_t count = 0;
    while (GetParam().drops_at_source ? count < kPlenty : losses().lost() < 10)
      EXPECT_TRUE(sink_->send(numbered(count++, size)));
    return count;
  }

  /// Closes the sink, takes what there is up to message `last`, and checks that it comes in order,
  /// and that what does not come was counted. Gives how many came.
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
      EXPECT_EQ(message.characters(),
                numbered(seq, static_cast<std::int32_t>(message.elements.size())).characters());
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
