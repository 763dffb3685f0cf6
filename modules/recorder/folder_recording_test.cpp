// SPDX-License-Identifier: Apache-2.0
#include "folder_recording.h"

#include <sys/resource.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <utility>

#include <gtest/gtest.h>

#include <hc/link/link.h>
#include <hc/mtp/codec.h>

namespace {

namespace fs = std::filesystem;

class Folder : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "hc-test-XXXXXX").string();
    root = ::mkdtemp(name.data());
    kept = (root / "kept").string();
  }
  void TearDown() override { fs::remove_all(root); }

  static std::unique_ptr<Recording> recording(const std::string& folder,
                                              const std::vector<std::string>& streams) {
    auto made = open_folder(folder, streams);
    EXPECT_TRUE(made) << made.error().text();
    return made ? std::move(*made) : nullptr;
  }

  static hc::Error refusal(const std::string& folder, const std::vector<std::string>& streams) {
    auto made = open_folder(folder, streams);
    EXPECT_FALSE(made);
    return made ? hc::Error() : made.error();
  }

  /// A message with so many bytes of elements.
  static hc::Message sized(std::int32_t size) {
    hc::Header header;
    header.info = {hc::MatrixType::IntensityImage, 1, hc::Scalar::U8, hc::Encoding::Binary};
    header.width = size;
    header.height = 1;
    hc::Draft draft = hc::Draft::make(header);
    std::ranges::fill(draft.elements(), std::byte('a'));
    return std::move(draft).finish();
  }

  static std::string read(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  /// How many messages a file has, all of them whole.
  static std::uint64_t count(const fs::path& path) {
    auto source = hc::open_source({"file", path.string(), {}});
    if (!source) return 0;
    hc::Message message;
    while (true) {
      auto got = hc::receive(**source, message);
      EXPECT_TRUE(got) << path << ": " << got.error().text();
      if (!got || !*got) return (*source)->traffic().messages;
    }
  }

  fs::path root;
  std::string kept;
};

TEST_F(Folder, AnErrorLeavesNothingBehind) {
  const std::string too_long(300, 'x');
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(refusal(kept, {"eyes.left", too_long}).code, hc::Code::System);
    EXPECT_FALSE(fs::exists(kept));
  }
  fs::create_directories(kept);
  EXPECT_EQ(refusal(kept, {"eyes.left", too_long}).code, hc::Code::System);
  EXPECT_TRUE(fs::is_empty(kept));
}

TEST_F(Folder, HasAFileOfEachStream) {
  auto made = recording(kept, {"eyes.left", "eyes.right", "neck.pose"});
  ASSERT_TRUE(made->record(0, sized(3)));
  ASSERT_TRUE(made->record(1, sized(100000)));
  ASSERT_TRUE(made->record(0, sized(4)));
  ASSERT_TRUE(made->close());
  EXPECT_EQ(made->place(), kept);
  EXPECT_EQ(made->messages(), 3U);
  EXPECT_EQ(made->lost(), 0U);
  EXPECT_EQ(read(root / "kept/eyes.left.mtp"), hc::encode(sized(3)) + hc::encode(sized(4)));
  EXPECT_EQ(read(root / "kept/eyes.right.mtp"), hc::encode(sized(100000)));
  EXPECT_TRUE(fs::exists(root / "kept/neck.pose.mtp"));
}

TEST_F(Folder, OfAnEarlierProcessIsLeftAlone) {
  auto record_one = [&](const std::string& folder) {
    auto made = recording(folder, {"a.out"});
    EXPECT_TRUE(made->record(0, sized(1)));
    EXPECT_TRUE(made->close());
    return made->place();
  };
  EXPECT_EQ(record_one(kept), kept);
  EXPECT_EQ(record_one(kept), kept + "_2");
  EXPECT_EQ(record_one(kept + "/"), kept + "_3");
  EXPECT_EQ(recording(kept, {"b.out"})->place(), kept + "_4");
  for (const char* file : {"kept/a.out.mtp", "kept_2/a.out.mtp", "kept_3/a.out.mtp"})
    EXPECT_EQ(count(root / file), 1U) << file;
}

TEST_F(Folder, WrongNamesAreRefused) {
  for (const auto& [streams, what] :
       {std::pair(std::vector<std::string>{""}, "\"\" cannot be a file name"),
        {{"../a.out"}, "\"../a.out\" cannot be a file name"},
        {{"a.out", "a.out"}, "\"a.out\" is there twice"}}) {
    const auto error = refusal(kept, streams);
    EXPECT_EQ(error.code, hc::Code::Invalid);
    EXPECT_EQ(error.detail, std::string("streams: ") + what);
  }
  EXPECT_FALSE(fs::exists(kept));
}

TEST_F(Folder, WhereNoneCanBeMadeIsAnError) {
  std::ofstream(root / "file") << "a";
  const std::string below = (root / "file/kept").string();
  EXPECT_EQ(refusal(below, {"a.out"}).detail, below + ": Not a directory");
  const std::string name(300, 'a');
  EXPECT_EQ(refusal(kept, {name}).detail,
            "open(" + kept + "/" + name + ".mtp): File name too long");
}

/// Files become no larger, as on a full disk.
class FullDisk : public Folder {
 protected:
  static constexpr rlim_t kMost = 100000;  // [byte]

  void SetUp() override {
    Folder::SetUp();
    before_ = std::signal(SIGXFSZ, SIG_IGN);
    ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &limit_), 0);
    const rlimit small{kMost, limit_.rlim_max};
    ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  }
  void TearDown() override {
    ::setrlimit(RLIMIT_FSIZE, &limit_);
    std::signal(SIGXFSZ, before_);
    Folder::TearDown();
  }

  /// Records until the disk is full; every message that is said to be recorded is whole.
  void fill(std::int32_t size) {
    auto made = recording(kept, {"a.out", "b.out"});
    hc::Status recorded = made->record(1, sized(10));
    for (int i = 0; recorded && i < 20000; ++i) recorded = made->record(0, sized(size));
    ASSERT_FALSE(recorded);
    EXPECT_EQ(recorded.error().code, hc::Code::System);
    EXPECT_EQ(recorded.error().detail, kept + "/a.out.mtp: write(): File too large");
    EXPECT_EQ(made->record(1, sized(1)).error().detail, recorded.error().detail);
    EXPECT_EQ(made->close().error().detail, recorded.error().detail);
    const auto whole = count(root / "kept/a.out.mtp");
    EXPECT_GT(whole, 0U);
    EXPECT_EQ(count(root / "kept/b.out.mtp"), 1U);
    EXPECT_EQ(made->messages() - made->lost(), whole + 1);
  }

 private:
  rlimit limit_{};
  void (*before_)(int) = nullptr;
};

TEST_F(FullDisk, LeavesWholeMessagesOfThoseThatAreWrittenAtOnce) {
  fill(30000);
}

TEST_F(FullDisk, LeavesWholeMessagesOfThoseThatAreGathered) {
  fill(100);
}

}  // namespace
