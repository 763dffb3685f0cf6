// SPDX-License-Identifier: Apache-2.0
#include <hc/graph/run/file_watch.h>

#include <gtest/gtest.h>

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

  std::unique_ptr<EventLoop> loop_ = std::move(*EventLoop::make());
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
