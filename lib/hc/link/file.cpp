// SPDX-License-Identifier: Apache-2.0
// `file:PATH`: a file, a FIFO or a device by name; the same bytes as on a wire.
#include <fcntl.h>

#include <hc/link/stream_link.h>
#include <hc/link/transports.h>

namespace hc::internal {
namespace {

Result<Descriptor> open_path(const Uri& uri, int flags) {
  constexpr int kMode = 0666;
  auto number = system_call("open", uri.rest, [&] {
    return ::open(uri.rest.c_str(), flags | O_CLOEXEC | O_NOCTTY, kMode);
  });
  if (!number) return number.error();
  Descriptor opened(*number);
  return reopen_without_waiting(opened.get(), flags & O_ACCMODE);
}

}  // namespace

Result<std::unique_ptr<Source>> open_file_source(const Uri& uri, const LinkOptions& options) {
  auto descriptor = open_path(uri, O_RDONLY);
  if (!descriptor) return descriptor.error();
  ::posix_fadvise(descriptor->get(), 0, 0, POSIX_FADV_SEQUENTIAL);
  return std::unique_ptr<Source>(new StreamSource(std::move(*descriptor), options));
}

Result<std::unique_ptr<Sink>> open_file_sink(const Uri& uri, const LinkOptions& options) {
  auto descriptor = open_path(uri, O_WRONLY | O_CREAT | O_TRUNC);
  if (!descriptor) return descriptor.error();
  return std::unique_ptr<Sink>(new StreamSink(std::move(*descriptor), options));
}

}  // namespace hc::internal
