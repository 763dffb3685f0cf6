// SPDX-License-Identifier: Apache-2.0
#include <hc/os/file_watch.h>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

namespace hc::internal {
namespace {

namespace fs = std::filesystem;

class FileWatchTest : public ::testing::Test {
 protected:
  FileWatchTest() {
    std::string pattern = ::testing::TempDir() + "file_watch.XXXXXX";
    folder_ = ::mkdtemp(pattern.data());
    fs::create_directory(folder_ / "sub");
    watch_ = std::move(*FileWatch::make(*loop_, [this] { ++calls_; }));
  }
  ~FileWatchTest() override { fs::remove_all(folder_); }

  void write(const std::string& name) const { std::ofstream(folder_ / name) << "text\n"; }
  /// Turns until it has been called so often; the watchdog is the test's.
  void await(int calls) {
    while (calls_ < calls) ASSERT_TRUE(loop_->turn());
    EXPECT_EQ(calls_, calls);
  }

  std::unique_ptr<Loop> loop_ = std::move(*Loop::make());
  std::unique_ptr<FileWatch> watch_;
  fs::path folder_;
  int calls_ = 0;
};

TEST_F(FileWatchTest, WritingAndPuttingInPlaceAreNoticed) {
  watch_->set_files({folder_ / "graph.toml", folder_ / "sub/eye.toml", "/nowhere/x.toml"});
  write("graph.toml");
  await(1);
  write("graph.toml.new");
  fs::rename(folder_ / "graph.toml.new", folder_ / "graph.toml");
  await(2);
  write("sub/eye.toml");
  await(3);
}

TEST_F(FileWatchTest, TakingAwayIsNoticed) {
  write("graph.toml");
  write("sub/eye.toml");
  watch_->set_files({folder_ / "graph.toml", folder_ / "sub/eye.toml"});
  fs::remove(folder_ / "graph.toml");
  await(1);
  fs::rename(folder_ / "sub/eye.toml", folder_ / "sub/eye.old");
  await(2);
}

TEST_F(FileWatchTest, ALinkIsFollowed) {
  fs::create_symlink("sub/there.toml", folder_ / "here.toml");
  fs::create_directory_symlink("sub", folder_ / "to_sub");
  watch_->set_files({folder_ / "here.toml", folder_ / "to_sub/eye.toml"});
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

TEST_F(FileWatchTest, AFolderMayBeReplaced) {
  watch_->set_files({folder_ / "sub/eye.toml"});
  fs::rename(folder_ / "sub", folder_ / "old");
  await(1);
  fs::create_directory(folder_ / "sub");
  await(2);
  write("old/eye.toml");  // it is none of ours any more
  write("sub/eye.toml");
  await(3);
  fs::remove_all(folder_ / "sub");
  await(4);
  write("old/eye.toml");
  fs::rename(folder_ / "old", folder_ / "sub");
  await(5);
  write("sub/eye.toml");
  await(6);
}

TEST_F(FileWatchTest, WhatTheSystemDidNotNoteMayHaveBeenOurs) {
  watch_->set_files({folder_ / "graph.toml"});
  int most = 0;
  std::ifstream("/proc/sys/fs/inotify/max_queued_events") >> most;
  const std::string other[] = {folder_ / "a", folder_ / "b"};  // in turn: equal notes are one
  for (int i = 0; i <= most; ++i)
    ::close(::open(other[i % 2].c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0600));
  write("graph.toml");
  await(1);
}

TEST_F(FileWatchTest, WhatIsDoneAtOnceIsOneCall) {
  watch_->set_files({folder_ / "a.toml", folder_ / "b.toml"});
  write("a.toml");
  write("b.toml");
  write("a.toml");
  await(1);
}

TEST_F(FileWatchTest, OtherFilesPlayNoPart) {
  watch_->set_files({folder_ / "sub/eye.toml"});
  watch_->set_files({folder_ / "graph.toml"});
  write("sub/eye.toml");
  write("other.toml");
  write("graph.toml");
  await(1);
}

}  // namespace
}  // namespace hc::internal
