// SPDX-License-Identifier: Apache-2.0
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <hc/link/link_conformance.h>
#include <hc/wire/codec.h>

namespace hc::testing {
namespace {

namespace fs = std::filesystem;

/// A folder that goes with the test.
class Folder {
 public:
  Folder() {
    std::string name = (fs::temp_directory_path() / "hc-test-XXXXXX").string();
    path_ = ::mkdtemp(name.data());
  }
  ~Folder() { fs::remove_all(path_); }
  [[nodiscard]] std::string operator/(const char* name) const { return (path_ / name).string(); }

 private:
  fs::path path_;
};

TEST(File, HoldsTheBytesOfTheWire) {
  Folder folder;
  auto sink = sink_of("file:" + (folder / "eyes.mtp"));
  ASSERT_TRUE(sink->send(numbered(1, 3)));
  ASSERT_TRUE(sink->send(numbered(2, 100000)));
  ASSERT_TRUE(sink->close());
  std::ifstream file(folder / "eyes.mtp", std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(file), {}};
  EXPECT_EQ(bytes, encode(numbered(1, 3)) + encode(numbered(2, 100000)));
  EXPECT_EQ(sink->traffic().bytes, bytes.size());

  auto source = source_of(folder / "eyes.mtp");
  Message message;
  EXPECT_TRUE(*receive(*source, message));
  EXPECT_TRUE(*receive(*source, message));
  EXPECT_EQ(message.characters(), numbered(2, 100000).characters());
  EXPECT_FALSE(*receive(*source, message));
  EXPECT_EQ(source->traffic().bytes, bytes.size());
}

TEST(File, ThatIsNotThereIsNotFound) {
  auto source = open_source(*parse_uri("/nowhere/eyes.mtp"));
  ASSERT_FALSE(source);
  EXPECT_EQ(source.error().code, Code::NotFound);
  EXPECT_EQ(source.error().detail, "open(/nowhere/eyes.mtp): No such file or directory");
  EXPECT_FALSE(open_sink(*parse_uri("/nowhere/eyes.mtp")));
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
  ASSERT_TRUE(*receive(*source, message));
  EXPECT_EQ(message.header.seq, 1);
  ASSERT_TRUE(*receive(*source, message));
  EXPECT_EQ(message.header.seq, 2);
  EXPECT_FALSE(*receive(*source, message));
}

TEST(File, AFullDiskIsTold) {
  auto sink = sink_of("file:/dev/full");
  auto sent = sink->send(numbered(0, 10));
  ASSERT_FALSE(sent);
  EXPECT_EQ(sent.error().detail, "write(): No space left on device");
}

}  // namespace
}  // namespace hc::testing
