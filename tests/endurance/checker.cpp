// SPDX-License-Identifier: Apache-2.0
// A consumer for the tests of endurance: notes each message in a file, and fails where set to.
#include <fcntl.h>
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstring>

#include <hc/base/clock.h>
#include <hc/module/module.h>
#include <hc/os/descriptor.h>

namespace {

/// FNV-1a, eight bytes at a time.
std::uint64_t hash_of(std::span<const std::byte> bytes) {
  std::uint64_t hash = 14695981039346656037U;
  while (!bytes.empty()) {
    std::uint64_t word = 0;
    const auto size = std::min(bytes.size(), sizeof word);
    std::memcpy(&word, bytes.data(), size);
    hash = (hash ^ word) * 1099511628211U;
    bytes = bytes.subspan(size);
  }
  return hash;
}

}  // namespace

int main(int argc, char** argv) {
  hc::Module module{"checker", "Notes when each message came, and what was in it."};
  auto in = module.input("in", hc::anything(), "any message");
  auto log = module.parameter("log", "/dev/null", "",
                              "file that a line is added to: monotonic time [ns], seq, hash, time");
  auto fails = module.parameter("fails", false, "", "end with status 1 at once");
  hc::Descriptor file;
  module.on_start([&] {
    if (*fails) throw hc::ModuleError("fails, as it was set to");
    file = hc::Descriptor(::open(log->c_str(), O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC, 0600));
    if (!file) throw hc::ModuleError(*log + ": cannot be opened");
  });
  module.on_raw(in, [&](const hc::Message& message) {
    char line[128];
    const int size =
        std::snprintf(line, sizeof line, "%lld %lld %016llx %lld\n",
                      static_cast<long long>(hc::SystemClock().monotonic().count()),
                      static_cast<long long>(message.header.seq),
                      static_cast<unsigned long long>(hash_of(message.elements)),
                      static_cast<long long>(hc::unix_nanoseconds(message.header.time)));
    // One call, so that no kill leaves a part of a line.
    if (::write(file.get(), line, static_cast<std::size_t>(size)) != size)
      throw hc::ModuleError(*log + ": cannot be written");
  });
  return module.run(argc, argv);
}
