// SPDX-License-Identifier: Apache-2.0
#include <hc/os/shared_memory.h>

#include <fcntl.h>
#include <linux/futex.h>
#include <linux/membarrier.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/syscall.h>

#include <climits>
#include <ctime>

namespace hc {
namespace {

constexpr int kFixedSize = F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_SEAL;

Result<std::byte*> map_bytes(int descriptor, std::uint64_t bytes, int protection) {
  void* data = ::mmap(nullptr, bytes, protection, MAP_SHARED, descriptor, 0);
  if (data == MAP_FAILED) return system_error("mmap", "");
  return static_cast<std::byte*>(data);
}

}  // namespace

Result<SharedMemory> SharedMemory::make(std::uint64_t bytes, std::uint64_t reserved) {
  SharedMemory memory;
  memory.descriptor_ = HC_TRY(open_descriptor("memfd_create", "", [] {
    return ::memfd_create("hypercolumn", MFD_CLOEXEC | MFD_ALLOW_SEALING);
  }));
  const int number = memory.descriptor_.get();
  HC_TRY(system_call("ftruncate", "shared memory, which ulimit -f limits",
                     [&] { return ::ftruncate(number, static_cast<off_t>(bytes)); }));
  memory.data_ = HC_TRY(map_bytes(number, bytes, PROT_READ | PROT_WRITE));
  memory.bytes_ = bytes;
  // Advice only: fewer pages to set up and to look up when writing images.
  ::madvise(memory.data_, bytes, MADV_HUGEPAGE);
  // The mapping made above stays writable; no other writable one can be made.
  HC_TRY(system_call("fcntl", "F_ADD_SEALS", [&] {
    return ::fcntl(number, F_ADD_SEALS, kFixedSize | F_SEAL_FUTURE_WRITE);
  }));
  HC_TRY(memory.reserve(reserved));
  return memory;
}

Result<SharedMemory> SharedMemory::map(Descriptor descriptor, std::uint64_t bytes) {
  auto refuse = [](std::string what) {
    return Error{Code::Malformed, "the received shared memory " + std::move(what)};
  };
  int seals = ::fcntl(descriptor.get(), F_GET_SEALS);
  if (seals < 0) return refuse("cannot be sealed");
  if ((seals & kFixedSize) != kFixedSize) return refuse("is not sealed against resizing");
  struct stat status {};
  if (::fstat(descriptor.get(), &status) != 0 ||
      static_cast<std::uint64_t>(status.st_size) != bytes)
    return refuse("has " + std::to_string(status.st_size) + " bytes, not " + std::to_string(bytes));
  auto data = map_bytes(descriptor.get(), bytes, PROT_READ);
  if (!data) return refuse("cannot be mapped: " + data.error().detail);
  SharedMemory memory;
  memory.data_ = *data;
  memory.bytes_ = bytes;
  return memory;
}

SharedMemory& SharedMemory::operator=(SharedMemory&& other) noexcept {
  std::swap(descriptor_, other.descriptor_);
  std::swap(data_, other.data_);
  std::swap(bytes_, other.bytes_);
  std::swap(reserved_, other.reserved_);
  return *this;
}

SharedMemory::~SharedMemory() {
  if (data_ != nullptr) ::munmap(data_, bytes_);
}

Status SharedMemory::reserve(std::uint64_t end) {
  end = (end + kPageBytes - 1) / kPageBytes * kPageBytes;
  if (end <= reserved_) return {};
  // Through the mapping, so that it uses large pages; kernels without MADV_POPULATE_WRITE allocate
  // through the descriptor.
  auto populated = system_call("madvise", "MADV_POPULATE_WRITE", [&] {
    return ::madvise(data_ + reserved_, end - reserved_, MADV_POPULATE_WRITE);
  });
  if (!populated) {
    HC_TRY(system_call("fallocate", "", [&] {
      return ::fallocate(descriptor_.get(), 0, static_cast<off_t>(reserved_),
                         static_cast<off_t>(end - reserved_));
    }));
  }
  reserved_ = end;
  return {};
}

Result<Descriptor> SharedMemory::read_only() const {
  std::string path = "/proc/self/fd/" + std::to_string(descriptor_.get());
  return open_descriptor("open", path, [&] { return ::open(path.c_str(), O_RDONLY | O_CLOEXEC); });
}

bool allow_ordering() {
  return ::syscall(SYS_membarrier, MEMBARRIER_CMD_REGISTER_GLOBAL_EXPEDITED, 0, 0) == 0;
}

bool can_order_everywhere() {
  auto commands = ::syscall(SYS_membarrier, MEMBARRIER_CMD_QUERY, 0, 0);
  return commands > 0 && (commands & MEMBARRIER_CMD_GLOBAL_EXPEDITED) != 0;
}

void order_everywhere() {
  std::atomic_thread_fence(std::memory_order_seq_cst);
  ::syscall(SYS_membarrier, MEMBARRIER_CMD_GLOBAL_EXPEDITED, 0, 0);
  std::atomic_thread_fence(std::memory_order_seq_cst);
}

void futex_wait(const SharedWord<std::uint32_t>& word, std::uint32_t value,
                std::chrono::nanoseconds timeout) {
  timespec time{};
  time.tv_sec = timeout.count() / 1'000'000'000;
  time.tv_nsec = timeout.count() % 1'000'000'000;
  ::syscall(SYS_futex, &word, FUTEX_WAIT, value, &time, nullptr, 0);
}

void futex_wake(const SharedWord<std::uint32_t>& word) {
  ::syscall(SYS_futex, &word, FUTEX_WAKE, INT_MAX, nullptr, nullptr, 0);
}

}  // namespace hc
