// SPDX-License-Identifier: Apache-2.0
#include <hc/os/file_watch.h>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <linux/fuse.h>
#include <poll.h>
#include <sys/mount.h>

#include <array>
#include <filesystem>
#include <fstream>

#include <hc/os/descriptor.h>
#include <hc/testing/files.h>

namespace hc {
namespace {

namespace fs = std::filesystem;

class FileWatchTest : public ::testing::Test {
 protected:
  FileWatchTest() { fs::create_directory(folder_ / "sub"); }

  void write(const std::string& name, const char* text = "text\n") const {
    std::ofstream(folder_ / name) << text;
  }
  void watch(const std::vector<std::string>& names) {
    std::vector<std::string> files;
    for (const auto& name : names) files.push_back(folder_ / name);
    if (watch_) return watch_->set_files(files);
    watch_ = std::move(*FileWatch::make(*loop_, files, [this] { ++calls_; }));
  }
  /// Turns the loop until there have been `calls`; the test has a time-out.
  void await(int calls) {
    while (calls_ < calls) ASSERT_TRUE(loop_->turn());
    EXPECT_EQ(calls_, calls);
  }

  std::unique_ptr<Loop> loop_ = std::move(*Loop::make());
  int calls_ = 0;
  std::unique_ptr<FileWatch> watch_;
  Folder folder_;
};

/// A disk that hangs: system calls on its files block until this is destroyed.
class HungDisk {
 public:
  explicit HungDisk(std::string folder) : folder_(std::move(folder)) {
    const std::string options =
        "fd=" + std::to_string(disk_.get()) + ",rootmode=40000,user_id=0,group_id=0";
    is_there_ = disk_ && ::mount("hung", folder_.c_str(), "fuse", 0, options.c_str()) == 0;
    if (!is_there_) return;
    HC_CHECK(next() == FUSE_INIT);
    struct {
      fuse_out_header header;
      fuse_init_out init;
    } answer{{sizeof answer, 0, unique_}, {}};
    answer.init.major = FUSE_KERNEL_VERSION;
    answer.init.minor = FUSE_KERNEL_MINOR_VERSION;
    answer.init.max_write = 4096;
    HC_CHECK(::write(disk_.get(), &answer, sizeof answer) == sizeof answer);
  }
  HungDisk(const HungDisk&) = delete;
  HungDisk& operator=(const HungDisk&) = delete;
  ~HungDisk() {
    if (is_there_) ::umount2(folder_.c_str(), MNT_DETACH);
  }

  explicit operator bool() const { return is_there_; }
  /// Waits for the next request; returns its opcode.
  std::uint32_t next() {
    std::array<std::byte, FUSE_MIN_READ_BUFFER * 2> question;
    fuse_in_header header{};
    HC_CHECK(::read(disk_.get(), question.data(), question.size()) >=
             static_cast<ssize_t>(sizeof header));
    std::memcpy(&header, question.data(), sizeof header);
    unique_ = header.unique;
    return header.opcode;
  }

 private:
  const std::string folder_;
  const Descriptor disk_{::open("/dev/fuse", O_RDWR | O_CLOEXEC)};
  bool is_there_ = false;
  std::uint64_t unique_ = 0;
};

TEST_F(FileWatchTest, WritingAndPuttingInPlaceAreNoticed) {
  watch({"graph.toml", "sub/eye.toml", "/nowhere/x.toml"});
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
  watch({"graph.toml", "sub/eye.toml"});
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
  watch({"here.toml", "to_sub/eye.toml"});
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
  watch({"a.toml", "b.toml"});
  write("a.toml");
  write("b.toml");
  write("a.toml");
  await(1);
}

TEST_F(FileWatchTest, AnEditWhileTheFilesAreSetAnewCounts) {
  write("graph.toml");
  watch({"graph.toml"});
  write("graph.toml", "other\n");
  watch({"graph.toml", "new.toml"});
  await(1);
}

TEST_F(FileWatchTest, OtherFilesPlayNoPart) {
  watch({"sub/eye.toml", "graph.toml"});
  watch({"graph.toml"});
  write("sub/eye.toml");
  write("other.toml");
  write("graph.toml");
  await(1);
}

TEST_F(FileWatchTest, WhetherAFileWasThereIsKnown) {
  write("graph.toml");
  watch({"graph.toml"});
  EXPECT_TRUE(watch_->was_there(folder_ / "graph.toml"));
  fs::remove(folder_ / "graph.toml");
  await(1);
  EXPECT_FALSE(watch_->was_there(folder_ / "graph.toml"));
}

TEST_F(FileWatchTest, ALookThatHangsHoldsUpNobody) {
  HungDisk disk(folder_ / "sub");
  if (!disk) GTEST_SKIP() << "only root can mount a disk that hangs";
  watch({"graph.toml"});
  watch({"graph.toml", "sub/eye.toml"});
  ASSERT_EQ(disk.next(), static_cast<std::uint32_t>(FUSE_LOOKUP));
  watch({"sub/eye.toml"});
  EXPECT_TRUE(loop_->turn(std::chrono::milliseconds(0)));
  watch_.reset();
}

}  // namespace
}  // namespace hc
