// SPDX-License-Identifier: Apache-2.0
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <tuple>

#include <hc/mtp/codec.h>
#include <hc/testing/files.h>
#include <hc/testing/link_conformance.h>

namespace hc::testing {
namespace {
namespace fs = std::filesystem;

TEST(File, HoldsTheBytesOfTheWire) {
  Folder folder;
  auto sink = sink_of("file:" + (folder / "eyes.mtp"));
  ASSERT_TRUE(sink->send(numbered(1, 3)));
  ASSERT_TRUE(sink->send(numbered(2, 100000)));
  ASSERT_TRUE(sink->close());
  const std::string bytes = bytes_of(folder / "eyes.mtp");
  EXPECT_EQ(bytes, encode(numbered(1, 3)) + encode(numbered(2, 100000)));
  EXPECT_EQ(sink->traffic().bytes, bytes.size());

  auto source = source_of(folder / "eyes.mtp");
  Message message;
  EXPECT_TRUE(*receive(*source, message));
  EXPECT_EQ(next(*source).text(), numbered(2, 100000).text());
  EXPECT_FALSE(*receive(*source, message));
  EXPECT_EQ(source->traffic().bytes, bytes.size());
}

TEST(File, ThatIsNotThereIsNotFound) {
  const auto source = refused(open_source(*parse_uri("/nowhere/eyes.mtp")));
  EXPECT_EQ(source.code, Code::NotFound);
  EXPECT_EQ(source.detail, "open(/nowhere/eyes.mtp): No such file or directory");
  EXPECT_FALSE(open_sink(*parse_uri("/nowhere/eyes.mtp")));
}

TEST(File, OfMcapIsNotWritten) {
  Folder folder;
  EXPECT_EQ(open_sink({"file", folder / "x.mcap", {}}).error().code, Code::Invalid);
  EXPECT_FALSE(fs::exists(folder / "x.mcap"));
}

TEST(File, R40_IsReadOnBehindDamage) {
  Folder folder;
  std::ofstream(folder / "x") << encode(numbered(0, 3)) << "1 7 0 0 8 0 40101 0 7 50000 1\nshort\n"
                              << encode(numbered(1, 3)) << encode(numbered(2, 30000));
  auto source = source_of(folder / "x");
  Message message;
  ASSERT_TRUE(*receive(*source, message));
  auto damaged = receive(*source, message);
  ASSERT_FALSE(damaged);
  ASSERT_TRUE(source->resume());
  EXPECT_EQ(next(*source).header.seq, 1);
  EXPECT_EQ(next(*source).header.seq, 2);
  EXPECT_FALSE(*receive(*source, message));
}

void send_to(const std::string& uri, const Message& message, LogSink log = {}) {
  LinkOptions options;
  options.log = std::move(log);
  auto sink = sink_of(uri, options);
  ASSERT_TRUE(sink->send(message));
  ASSERT_TRUE(sink->close());
}

TEST(File, ThatHasContentsStays) {
  Folder folder;
  std::string said;
  auto log = [&](Level, std::string_view line) { said += line; };
  const std::string path = folder / "eyes.mtp";
  for (int i = 0; i < 3; ++i) send_to("file:" + path, numbered(i, 3), log);
  EXPECT_EQ(bytes_of(path), encode(numbered(0, 3)));
  EXPECT_EQ(bytes_of(folder / "eyes_2.mtp"), encode(numbered(1, 3)));
  EXPECT_EQ(bytes_of(folder / "eyes_3.mtp"), encode(numbered(2, 3)));
  EXPECT_EQ(said, "file:" + path + ": the file stays as it is; continuing in " +
                      (folder / "eyes_2.mtp") + "file:" + path +
                      ": the file stays as it is; continuing in " + (folder / "eyes_3.mtp"));
}

TEST(File, IsContinuedBehindItsLastWholeMessage) {
  Folder folder;
  const std::string path = folder / "eyes.mtp", whole = encode(numbered(1, 200'000));
  std::string kept;
  // What a killed writer leaves: nothing, or a message cut in its head, its elements, its end.
  for (const std::size_t cut :
       {std::size_t{0}, std::size_t{1}, std::size_t{20}, std::size_t{60'000}, std::size_t{150'000},
        whole.size() - 1, whole.size()}) {
    std::ofstream(path, std::ios::app) << whole.substr(0, cut);
    send_to("file:" + path + "?append=1", numbered(2, 100));
    kept += (cut == whole.size() ? whole : "") + encode(numbered(2, 100));
    ASSERT_EQ(bytes_of(path).size(), kept.size()) << cut;
    ASSERT_TRUE(bytes_of(path) == kept) << cut;
  }
}

TEST(File, ThatHasOtherContentsIsNotContinued) {
  Folder folder;
  std::ofstream(folder / "x") << "no messages\n";
  send_to("file:" + (folder / "x") + "?append=1", numbered(1, 3));
  EXPECT_EQ(bytes_of(folder / "x"), "no messages\n");
  EXPECT_EQ(bytes_of(folder / "x_2"), encode(numbered(1, 3)));
}

TEST(File, ThatIsOptionalLosesWhatItCannotTake) {
  for (const char* path : {"/dev/full", "/nowhere/eyes.mtp"}) {
    int errors = 0;
    LinkOptions options;
    options.log = [&](Level severity, std::string_view line) {
      EXPECT_EQ(severity, Level::Error);
      EXPECT_NE(line.find(std::string("recording into ") + path + " ended: "), line.npos) << line;
      ++errors;
    };
    auto sink = sink_of(std::string("file:") + path + "?optional=1", options);
    for (int i = 0; i < 3; ++i) EXPECT_TRUE(sink->send(numbered(i, 100'000)));
    EXPECT_TRUE(sink->close());
    EXPECT_EQ(errors, 1);
    EXPECT_EQ(sink->traffic().dropped_disconnect, 3U);
  }
}

TEST(File, AFullDiskIsReported) {
  auto sink = sink_of("file:/dev/full");
  EXPECT_EQ(refused(sink->send(numbered(0, 10))).detail, "write(): No space left on device");
}

class OnAFullDisk : public ::testing::TestWithParam<std::tuple<int, std::string>> {};

TEST_P(OnAFullDisk, AreWholeMessages) {
  const auto& [size, options] = GetParam();
  const FullDisk full(100'000);
  Folder folder;
  auto sink = sink_of("file:" + (folder / "eyes.mtp") + options);
  Status sent;
  for (int i = 0; sent && i < 20'000; ++i) sent = sink->send(numbered(i, size));
  ASSERT_FALSE(sent);
  EXPECT_EQ(sent.error().detail, "write(): File too large");
  EXPECT_FALSE(sink->close());

  auto source = source_of(folder / "eyes.mtp");
  Message message;
  while (must(receive(*source, message))) continue;
  const auto traffic = sink->traffic();
  EXPECT_GT(source->traffic().messages, 0U);
  EXPECT_EQ(source->traffic().messages, traffic.messages - traffic.dropped_disconnect);
}

// With a rate, messages wait in the queue.
INSTANTIATE_TEST_SUITE_P(SmallAndLarge, OnAFullDisk,
                         ::testing::Combine(::testing::Values(100, 30'000),
                                            ::testing::Values(std::string(),
                                                              std::string("?rate=5000"))));

std::pair<std::string, std::string> make_fifo() {
  static Folder folder;
  static int number = 0;
  std::string path = folder / std::to_string(number++).c_str();
  EXPECT_EQ(::mkfifo(path.c_str(), 0600), 0);
  return {"file:" + path, "file:" + path};
}

INSTANTIATE_TEST_SUITE_P(Fifo, LinkConformance,
                         ::testing::Values(Transport{"fifo", make_fifo, false, true}));

TEST(Fifo, HasNoEndBeforeAWriterHasCome) {
  auto [from, to] = make_fifo();
  auto source = source_of(from);
  Message message;
  EXPECT_EQ(*source->take(message), Got::Nothing);
  Stop stop;
  stop.raise();
  EXPECT_EQ(receive(*source, message, stop.options().stop).error().code, Code::Stopped);
  ASSERT_TRUE(sink_of(to)->close());
  EXPECT_FALSE(*receive(*source, message));
}

TEST(Fifo, WaitingForAReaderEndsWhenAskedToStop) {
  Stop stop;
  stop.raise();
  EXPECT_EQ(refused(open_sink(*parse_uri(make_fifo().second), stop.options())).code, Code::Stopped);
}

TEST(Fifo, AWriterWaitsForAReader) {
  auto [from, to] = make_fifo();
  std::thread writer([uri = to] {
    auto sink = sink_of(uri);
    ASSERT_TRUE(sink->send(numbered(1, 10)));
    ASSERT_TRUE(sink->close());
  });
  auto source = source_of(from);
  Message message;
  ASSERT_TRUE(*receive(*source, message));
  EXPECT_FALSE(*receive(*source, message));
  writer.join();
}

}  // namespace
}  // namespace hc::testing
