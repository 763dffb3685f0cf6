// SPDX-License-Identifier: Apache-2.0
// Floor: a ring of slots in shared memory, nothing else. Mode `poll` looks at a counter until it
// changes; mode `futex` sleeps on it. No peer, no names that outlive a crash, no checks.
#include <fcntl.h>
#include <linux/futex.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <climits>
#include <new>

#include "harness.h"

namespace {

using bench::Setup;
using Counter = std::atomic<std::uint32_t>;  // counts messages, modulo 2^32

/// Each counter has two cache lines, since processors fetch them in pairs.
struct alignas(128) Line {
  Counter count;
};

constexpr int kMaxReaders = 4;

struct Ring {
  Line published;
  Line sleeping_readers;
  Line publisher_sleeps;
  Line read[kMaxReaders];
  alignas(128) std::byte slots[128];
};

class Memory {
 public:
  explicit Memory(const Setup& setup)
      : sleeps(setup.mode == "futex"),
        slots(setup.is_small() ? 1024 : 4),
        slot_bytes((setup.bytes + 63) / 64 * 64),
        name_("/hc_bench_" + setup.link),
        size_(sizeof(Ring) + slots * slot_bytes) {
    int file = bench::require(::shm_open(name_.c_str(), O_RDWR | O_CREAT, 0600), "shm_open");
    bench::require(::ftruncate(file, static_cast<off_t>(size_)), "ftruncate");
    void* at = ::mmap(nullptr, size_, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_POPULATE, file, 0);
    if (at == MAP_FAILED) bench::fail("mmap");
    ::close(file);
    ring = static_cast<Ring*>(at);  // zeros, which are counters at 0
  }
  Memory(const Memory&) = delete;
  Memory& operator=(const Memory&) = delete;
  ~Memory() {
    ::munmap(ring, size_);
    ::shm_unlink(name_.c_str());
  }

  [[nodiscard]] std::span<std::byte> slot(std::uint32_t number, std::size_t bytes) const {
    return {ring->slots + number % slots * slot_bytes, bytes};
  }

  Ring* ring = nullptr;
  const bool sleeps;
  const std::uint32_t slots;
  const std::size_t slot_bytes;

 private:
  std::string name_;
  std::size_t size_;
};

void sleep_while(const Counter& word, std::uint32_t value) {
  ::syscall(SYS_futex, &word, FUTEX_WAIT, value, nullptr, nullptr, 0);
}

void wake_all(const Counter& word) {
  ::syscall(SYS_futex, &word, FUTEX_WAKE, INT_MAX, nullptr, nullptr, 0);
}

class Publisher final : public bench::Publisher {
 public:
  explicit Publisher(const Setup& setup)
      : memory_(setup), bytes_(setup.bytes), readers_(setup.readers) {}

  std::span<std::byte> loan() override {
    while (published_ - slowest_ >= memory_.slots) await_slot();
    return memory_.slot(published_, bytes_);
  }

  void publish() override {
    auto& published = memory_.ring->published.count;
    ++published_;
    if (!memory_.sleeps) {
      published.store(published_, std::memory_order_release);
      return;
    }
    published.store(published_);
    if (memory_.ring->sleeping_readers.count.load() != 0) wake_all(published);
  }

 private:
  void await_slot() {
    bench::Spin spin;
    while (true) {
      auto& sleeps = memory_.ring->publisher_sleeps.count;
      if (memory_.sleeps) sleeps.store(1);
      std::uint32_t most = 0;
      Counter* slowest = &memory_.ring->read[0].count;
      for (int i = 0; i < readers_; ++i) {
        auto& read = memory_.ring->read[i].count;
        std::uint32_t behind = published_ - read.load();
        if (behind >= most) slowest = &read, most = behind;
      }
      slowest_ = published_ - most;
      if (most < memory_.slots) break;
      if (memory_.sleeps)
        sleep_while(*slowest, slowest_);
      else
        spin();
    }
    memory_.ring->publisher_sleeps.count.store(0, std::memory_order_relaxed);
  }

  Memory memory_;
  std::size_t bytes_;
  int readers_;
  std::uint32_t published_ = 0, slowest_ = 0;
};

class Subscriber final : public bench::Subscriber {
 public:
  explicit Subscriber(const Setup& setup)
      : memory_(setup), bytes_(setup.bytes), tail_(memory_.ring->read[setup.reader].count) {}

  std::span<const std::byte> receive() override {
    if (begun_) release();
    begun_ = true;
    if (published_ == read_) await_message();
    return memory_.slot(read_, bytes_);
  }

 private:
  void release() {
    ++read_;
    if (!memory_.sleeps) {
      tail_.store(read_, std::memory_order_release);
      return;
    }
    tail_.store(read_);
    // Not for every slot: the publisher would be woken for one message each.
    if (published_ - read_ <= memory_.slots / 2 && memory_.ring->publisher_sleeps.count.load() != 0)
      wake_all(tail_);
  }

  void await_message() {
    const auto& published = memory_.ring->published.count;
    auto& sleepers = memory_.ring->sleeping_readers.count;
    bench::Spin spin;
    while ((published_ = published.load(std::memory_order_acquire)) == read_) {
      if (!memory_.sleeps) {
        spin();
        continue;
      }
      sleepers.fetch_add(1);
      if (published.load() == read_) sleep_while(published, read_);
      sleepers.fetch_sub(1);
    }
  }

  Memory memory_;
  std::size_t bytes_;
  Counter& tail_;
  bool begun_ = false;
  std::uint32_t published_ = 0, read_ = 0;
};

}  // namespace

int main(int argc, char** argv) {
  return bench::run<Publisher, Subscriber>(argc, argv);
}
