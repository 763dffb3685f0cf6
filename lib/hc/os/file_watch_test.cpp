// SPDX-License-Identifier: Apache-2.0
#include <hc/os/file_watch.h>

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

namespace hc {
namespace {

namespace fs = std::filesystem;

class FileWatchTest : public ::testing::Test {
 protected:
  FileWatchTest() {
    std::string pattern = ::testing::TempDir() + "file_watch.XXXXXX";
    folder_ = ::mkdtemp(pattern.data());
    fs::create_directory(folder_ / "sub");
  }
  ~FileWatchTest() override { fs::remove_all(folder_); }

  void write(const std::string& name, const char* text = "text\n") const {
    std::ofstream(folder_ / name) << text;
  }
  /// Turns until it has been called so often; the watchdog is the test's.
  void await(int calls) {
    while (calls_ < calls) ASSERT_TRUE(loop_->turn());
    EXPECT_EQ(calls_, calls);
  }

  std::unique_ptr<Loop> loop_ = std::move(*Loop::make());
  int calls_ = 0;
  FileWatch watch_{*loop_, [this] { ++calls_; }};
  fs::path folder_;
};

TEST_F(FileWatchTest, WritingAndPuttingInPlaceAreNoticed) {
  watch_.set_files({folder_ / "graph.toml", folder_ / "sub/eye.toml", "/nowhere/x.toml"});
  write("graph.toml");
  await(1);
  write("graph.toml.new");
  fs::rename(folder_ / "graph.toml.new", folder_ / "graph.toml");
  await(2);
  write("sub/eye.toml");
  await(3);
  write("sub/eye.toml", "other\n");
  await(4);
}

TEST_F(FileWatchTest, TakingAwayIsNoticed) {
  write("graph.toml");
  write("sub/eye.toml");
  watch_.set_files({folder_ / "graph.toml", folder_ / "sub/eye.toml"});
  fs::remove(folder_ / "graph.toml");
  await(1);
  fs::rename(folder_ / "sub", folder_ / "old");
  await(2);
  fs::rename(folder_ / "old", folder_ / "sub");
  await(3);
}

TEST_F(FileWatchTest, ALinkIsFollowed) {
  fs::create_symlink("sub/there.toml", folder_ / "here.toml");
  fs::create_directory_symlink("sub", folder_ / "to_sub");
  watch_.set_files({folder_ / "here.toml", folder_ / "to_sub/eye.toml"});
  write("sub/there.toml");
  await(1);
  write("sub/eye.toml");
  await(2);
  fs::create_directory(folder_ / "other");
  fs::create_directory_symlink("other", folder_ / "new");
  fs::rename(folder_ / "new", folder_ / "to_sub");
  await(3);
  fs::remove(folder_ / "here.toml");
  fs::create_symlink("sub/eye.toml", folder_ / "here.toml");
  await(4);
}

TEST_F(FileWatchTest, WhatIsDoneAtOnceIsOneCall) {
  watch_.set_files({folder_ / "a.toml", folder_ / "b.toml"});
  write("a.toml");
  write("b.toml");
  write("a.toml");
  await(1);
}

TEST_F(FileWatchTest, AnEditWhileTheFilesAreSetAnewCounts) {
  write("graph.toml");
  watch_.set_files({folder_ / "graph.toml"});
  write("graph.toml", "other\n");
  watch_.set_files({folder_ / "graph.toml", folder_ / "new.toml"});
  await(1);
}

TEST_F(FileWatchTest, OtherFilesPlayNoPart) {
  watch_.set_files({folder_ / "sub/eye.toml"});
  watch_.set_files({folder_ / "graph.toml"});
  write("sub/eye.toml");
  write("other.toml");
  write("graph.toml");
  await(1);
}

}  // namespace
}  // namespace hc
