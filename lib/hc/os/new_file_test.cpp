// SPDX-License-Identifier: Apache-2.0
#include <hc/os/new_file.h>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/stat.h>

#include <atomic>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include <hc/os/program.h>
#include <hc/testing/files.h>
#include <hc/testing/must.h>

namespace hc {
namespace {

namespace fs = std::filesystem;

class NewFiles : public ::testing::Test {
 protected:
  [[nodiscard]] std::string at(const std::string& name) const { return folder_ / name; }
  /// Begins a file and writes to it; returns its name.
  [[nodiscard]] std::string begin(const std::string& name, std::string_view contents) const {
    auto file = must(begin_file(at(name)));
    EXPECT_TRUE(write_all(file.descriptor.get(), contents));
    return fs::path(file.path).filename();
  }
  [[nodiscard]] std::string contents(const std::string& name) const { return bytes_of(at(name)); }

 private:
  Folder folder_;
};

TEST_F(NewFiles, WhatHasContentsStays) {
  EXPECT_EQ(begin("x.mtp", "first"), "x.mtp");
  EXPECT_EQ(begin("x.mtp", "second"), "x_2.mtp");
  EXPECT_EQ(begin("x.mtp", "third"), "x_3.mtp");
  EXPECT_EQ(contents("x.mtp") + contents("x_2.mtp"), "firstsecond");
  EXPECT_EQ(begin("plain", "1"), "plain");
  EXPECT_EQ(begin("plain", "2"), "plain_2");
}

TEST_F(NewFiles, AnEmptyFileIsFree) {
  EXPECT_TRUE(must(begin_file(at("x.mtp"))).is_new);
  EXPECT_FALSE(must(begin_file(at("x.mtp"))).is_new);
  EXPECT_EQ(begin("x.mtp", "first"), "x.mtp");
}

TEST_F(NewFiles, TwoThatBeginAtTheSameTimeHaveTwoFiles) {
  auto first = begin_file(at("x.mtp")), second = begin_file(at("x.mtp"));
  ASSERT_TRUE(first && second);
  EXPECT_EQ(first->path, at("x.mtp"));
  EXPECT_EQ(second->path, at("x_2.mtp"));
  EXPECT_FALSE(continue_file(at("x.mtp")));
}

TEST_F(NewFiles, AFolderThatIsNotThereIsAnError) {
  EXPECT_EQ(begin_file(at("none/x.mtp")).error().code, Code::NotFound);
}

TEST_F(NewFiles, DevicesAndPipesAreOpenedAsTheyAre) {
  auto null = must(begin_file("/dev/null"));
  EXPECT_EQ(null.path, "/dev/null");
  ASSERT_TRUE(replace_file("/dev/null", "x"));
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

TEST_F(NewFiles, ADescriptorByNameIsAppendedTo) {
  std::ofstream(at("x")) << "shell ";
  const Descriptor own(::open(at("x").c_str(), O_WRONLY | O_APPEND));
  auto file = must(begin_file("/proc/self/fd/" + std::to_string(own.get())));
  ASSERT_TRUE(write_all(file.descriptor.get(), "ours"));
  EXPECT_EQ(contents("x"), "shell ours");
}

TEST(FreeName, HasANumberWhereTheNameIsTaken) {
  const std::set<std::string> taken = {"kept.mcap", "kept_2.mcap", "kept/", "runs/2026.11.24"};
  auto name = [&](const std::string& path, std::string_view ending) {
    return free_name(path, ending, [&](const auto& each) { return !taken.contains(each); });
  };
  EXPECT_EQ(name("new.mcap", ".mcap"), "new.mcap");
  EXPECT_EQ(name("new/", ""), "new/");
  EXPECT_EQ(name("kept.mcap", ".mcap"), "kept_3.mcap");
  EXPECT_EQ(name("kept/", ""), "kept_2");
  EXPECT_EQ(name("runs/2026.11.24", ""), "runs/2026.11.24_2");
}

TEST(FreeName, OfTheWorkingFolderIsBesideIt) {
  const auto here = fs::current_path();
  auto sibling = [](const std::string& path) {
    return free_name(path, "", [&](const std::string& each) { return each != path; });
  };
  EXPECT_EQ(sibling("."), here.string() + "_2");
  EXPECT_EQ(sibling("./"), here.string() + "_2");
  EXPECT_EQ(sibling("x/.."), here.string() + "_2");
  EXPECT_EQ(sibling(".."), here.parent_path().string() + "_2");
}

TEST_F(NewFiles, AFileIsReplacedWholeOrNotAtAll) {
  ASSERT_TRUE(replace_file(at("x"), "first"));
  {
    const FullDisk full(4);
    EXPECT_NE(refused(replace_file(at("x"), "second")).detail.find("File too large"),
              std::string::npos);
  }
  EXPECT_EQ(contents("x"), "first");
  EXPECT_FALSE(fs::exists(at("x.unfinished")));
}

TEST_F(NewFiles, AProcessThatDoesNotFinishIsNotWaitedForForEver) {
  ASSERT_TRUE(replace_file(at("x"), "first"));
  const Descriptor other(::open(at("x.unfinished").c_str(), O_RDONLY | O_CREAT | O_CLOEXEC, 0600));
  ASSERT_EQ(::flock(other.get(), LOCK_EX), 0);
  EXPECT_EQ(refused(replace_file(at("x"), "second")).detail,
            at("x.unfinished") + ": another process is writing it");
  EXPECT_EQ(contents("x"), "first");
}

TEST_F(NewFiles, APrivateFileIsNotWrittenWhereOthersCanRead) {
  std::ofstream(at("x.unfinished")) << "";
  ASSERT_EQ(::chmod(at("x.unfinished").c_str(), 0604), 0);
  EXPECT_EQ(refused(make_private_file(at("x"), "secret")).detail,
            at("x.unfinished") +
                ": other users can read it; remove it, or choose a file system that "
                "has permissions");
  EXPECT_FALSE(fs::exists(at("x")));
  EXPECT_EQ(contents("x.unfinished"), "");
  fs::remove(at("x.unfinished"));
  must(make_private_file(at("x"), "secret"));
  EXPECT_EQ(fs::status(at("x")).permissions(), fs::perms::owner_read | fs::perms::owner_write);
  must(make_private_file(at("x"), "another"));
  EXPECT_EQ(contents("x"), "secret");
}

TEST_F(NewFiles, AFileThatOthersCanReadBecomesPrivate) {
  std::ofstream(at("x")) << "old";
  ASSERT_EQ(::chmod(at("x").c_str(), 0666), 0);
  must(replace_private_file(at("x"), "secret"));
  EXPECT_EQ(contents("x"), "secret");
  EXPECT_EQ(fs::status(at("x")).permissions(), fs::perms::owner_read | fs::perms::owner_write);
  std::ofstream(at("x.unfinished")) << "";
  ASSERT_EQ(::chmod(at("x.unfinished").c_str(), 0606), 0);
  EXPECT_EQ(refused(replace_private_file(at("x"), "another secret")).detail,
            at("x.unfinished") +
                ": other users can read it; remove it, or choose a file system that "
                "has permissions");
  EXPECT_EQ(contents("x"), "secret");
}

TEST_F(NewFiles, WhatAnUnfinishedFileLinksToStays) {
  std::ofstream(at("other")) << "of others";
  fs::create_symlink(at("other"), at("x.unfinished"));
  EXPECT_FALSE(replace_file(at("x"), "ours"));
  EXPECT_FALSE(make_private_file(at("x"), "ours"));
  EXPECT_FALSE(replace_private_file(at("x"), "ours"));
  EXPECT_EQ(contents("other"), "of others");
}

TEST_F(NewFiles, ReplacedByManyAtOnceIsTheWholeOfOne) {
  const std::string texts[] = {std::string(100'000, 'a'), std::string(50'000, 'b')};
  ASSERT_TRUE(replace_file(at("x"), texts[0]));
  std::atomic<bool> is_over{false};
  {
    std::vector<std::jthread> writers;
    for (const auto& text : texts)
      writers.emplace_back([&, path = at("x")] {
        while (!is_over) static_cast<void>(replace_file(path, text));
      });
    for (int i = 0; i < 1000; ++i) {
      const auto read = contents("x");
      EXPECT_TRUE(read == texts[0] || read == texts[1]) << read.size();
    }
    is_over = true;
  }
  EXPECT_FALSE(fs::exists(at("x.unfinished")));
}

}  // namespace
}  // namespace hc
