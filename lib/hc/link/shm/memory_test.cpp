// SPDX-License-Identifier: Apache-2.0
#include <hc/link/shm/layout.h>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/syscall.h>

#include <array>
#include <cstddef>
#include <thread>

#include <hc/link/link.h>
#include <hc/testing/must.h>

namespace hc::internal {
namespace {

constexpr std::uint64_t kBytes = 8 * kPageBytes;

SharedMemory make(std::uint64_t reserved) {
  return must(SharedMemory::make(kBytes, reserved));
}

std::int64_t pages_of(const SharedMemory& memory) {
  struct stat status {};
  EXPECT_EQ(::fstat(memory.read_only()->get(), &status), 0);
  return status.st_blocks * 512 / static_cast<std::int64_t>(kPageBytes);
}

TEST(SharedMemory, IsSeenByBothSides) {
  auto written = make(kBytes);
  auto read = must(SharedMemory::map(std::move(*written.read_only()), kBytes));
  written.data()[kBytes - 1] = std::byte{7};
  EXPECT_EQ(read.data()[kBytes - 1], std::byte{7});
  EXPECT_NE(read.data(), written.data());
  EXPECT_EQ(read.size(), kBytes);
}

TEST(SharedMemory, OnlyItsMakerWritesAndNobodyResizes) {
  auto memory = make(kBytes);
  auto shown = must(memory.read_only());
  EXPECT_EQ(::mmap(nullptr, kBytes, PROT_WRITE, MAP_SHARED, shown.get(), 0), MAP_FAILED);
  // A peer may open what it was handed once more, to write; the seals still hold.
  Descriptor again(
      ::open(("/proc/self/fd/" + std::to_string(shown.get())).c_str(), O_RDWR | O_CLOEXEC));
  ASSERT_TRUE(again);
  EXPECT_EQ(::mmap(nullptr, kBytes, PROT_READ | PROT_WRITE, MAP_SHARED, again.get(), 0),
            MAP_FAILED);
  EXPECT_LT(::write(again.get(), "x", 1), 0);
  EXPECT_LT(::ftruncate(again.get(), 0), 0);
  EXPECT_LT(::ftruncate(again.get(), static_cast<off_t>(2 * kBytes)), 0);
  EXPECT_LT(::fallocate(again.get(), FALLOC_FL_PUNCH_HOLE | FALLOC_FL_KEEP_SIZE, 0, kPageBytes), 0);
  EXPECT_LT(::fcntl(again.get(), F_ADD_SEALS, F_SEAL_WRITE), 0);
}

TEST(SharedMemory, TakesPagesWhenTheyAreReserved) {
  auto memory = make(kPageBytes);
  EXPECT_EQ(pages_of(memory), 1);
  ASSERT_TRUE(memory.reserve(3 * kPageBytes - 1));
  EXPECT_EQ(pages_of(memory), 3);
  ASSERT_TRUE(memory.reserve(10));
  EXPECT_EQ(pages_of(memory), 3);
  ASSERT_TRUE(memory.reserve(kBytes));
  EXPECT_EQ(pages_of(memory), 8);
}

TEST(SharedMemory, OutlivesItsMaker) {
  auto memory = std::make_unique<SharedMemory>(make(kBytes));
  memory->data()[5] = std::byte{9};
  auto read = std::move(*SharedMemory::map(std::move(*memory->read_only()), kBytes));
  memory.reset();
  EXPECT_EQ(read.data()[5], std::byte{9});
}

TEST(SharedMemory, OfAnotherSizeIsRefused) {
  auto memory = make(kBytes);
  for (auto bytes : {kBytes - 1, kBytes + 1, kBytes + kPageBytes}) {
    EXPECT_EQ(
        refused(SharedMemory::map(std::move(*memory.read_only()), bytes)).text(),
        "Malformed: the received shared memory has 32768 bytes, not " + std::to_string(bytes));
  }
}

/// From now on this thread gets no pages for shared memory. False: the host does not let us.
bool refuse_pages() {
  auto same = [](unsigned value, unsigned char otherwise) {
    return sock_filter(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, value, 0, otherwise));
  };
  auto load = [](std::size_t offset) {
    return sock_filter(BPF_STMT(BPF_LD | BPF_W | BPF_ABS, static_cast<unsigned>(offset)));
  };
  std::array<sock_filter, 8> filter = {{
      load(offsetof(seccomp_data, nr)),
      same(SYS_fallocate, 1),
      BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ERRNO | ENOMEM),
      same(SYS_madvise, 3),
      load(offsetof(seccomp_data, args) + 2 * sizeof(std::uint64_t)),
      same(MADV_POPULATE_WRITE, 1),
      BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ERRNO | ENOMEM),
      BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW),
  }};
  sock_fprog program{filter.size(), filter.data()};
  return ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 &&
         ::prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) == 0;
}

/// Writing into a page that the host does not have would kill the publisher.
class NoPages : public ::testing::Test {
 protected:
  /// Sends so many large messages without pages; false where the host always has some.
  bool send(const std::string& options, int count, Status& sent) {
    std::string name = "shm:no-pages-" + std::to_string(::getpid());
    sink_ = std::move(*open_sink(*parse_uri(name + options)));
    source_ = std::move(*open_source(*parse_uri(name)));
    bool refused = false;
    std::thread publisher([&] {
      refused = refuse_pages();
      Message message =
          Draft::make({MatrixType::IntensityImage, 1, Scalar::U8, Encoding::Binary}, 1, 100'000)
              .finish();
      for (int i = 0; sent && i < count; ++i) sent = sink_->send(message);
    });
    publisher.join();
    return refused;
  }

  std::unique_ptr<Sink> sink_;
  std::unique_ptr<Source> source_;
};

TEST_F(NoPages, WhatTheHostHasNoPagesForIsNotWritten) {
  Status sent;
  if (!send("?keep=latest", 10, sent)) GTEST_SKIP() << "no seccomp here";
  EXPECT_TRUE(sent);
  EXPECT_EQ(sink_->traffic().dropped_memory, 10U);
  EXPECT_EQ(sink_->traffic().messages, 10U);
}

TEST_F(NoPages, WhoLosesNothingGetsAnErrorThatTheHostHasNone) {
  Status sent;
  if (!send("", 10, sent)) GTEST_SKIP() << "no seccomp here";
  ASSERT_FALSE(sent);
  EXPECT_EQ(sent.error().text(),
            "System: no room left: the host has no memory to share: fallocate(): Cannot allocate "
            "memory");
}

}  // namespace
}  // namespace hc::internal
