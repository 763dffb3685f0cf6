// SPDX-License-Identifier: Apache-2.0
// Any file: reading a recording in MCAP ends, with messages that can be written, or with errors
// that can be read on after.
#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <hc/mtp/codec.h>
#include <mcap/link.h>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const int kFile = ::memfd_create("fuzz", MFD_CLOEXEC);
  HC_CHECK(kFile >= 0 && ::ftruncate(kFile, 0) == 0);
  HC_CHECK(::pwrite(kFile, data, size, 0) == static_cast<ssize_t>(size));
  hc::LinkOptions options;
  options.limits.element_bytes = std::uint64_t{1} << 20;
  auto source =
      hc::mcap::read_recording({"file", "/proc/self/fd/" + std::to_string(kFile), {}}, options);
  if (!source) return 0;
  hc::Message message;
  while (true) {
    auto got = (*source)->take(message);
    if (!got && got.error().code == hc::Code::Truncated) return 0;
    if (got && *got == hc::Got::End) return 0;
    if (got)
      static_cast<void>(hc::encode(message));
    else
      HC_CHECK((*source)->resume().has_value());
  }
}
