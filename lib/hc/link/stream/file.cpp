// SPDX-License-Identifier: Apache-2.0
// `file:PATH`: a file, a FIFO or a device by name; the same bytes as on a wire.
#include <fcntl.h>
#include <sys/stat.h>

#include <hc/base/backoff.h>
#include <hc/link/stream/sink.h>
#include <hc/link/stream/source.h>
#include <hc/link/transports.h>

namespace hc::internal {
namespace {

/// Opens without waiting for the other end of a FIFO, which a signal to stop could not end.
Result<Descriptor> open_path(const Uri& uri, int flags, int stop) {
  constexpr int kMode = 0666;
  const char* path = uri.rest.c_str();
  Backoff backoff(std::chrono::milliseconds(1), std::chrono::milliseconds(200));
  while (true) {
    Descriptor opened(::open(path, flags | O_NONBLOCK | O_CLOEXEC | O_NOCTTY, kMode));
    if (opened) {
      widen_pipe(opened.get());
      return opened;
    }
    const int number = errno;
    if (number == EINTR) continue;
    struct stat status {};
    bool is_fifo = ::stat(path, &status) == 0 && S_ISFIFO(status.st_mode);
    if (number != ENXIO || !is_fifo) return system_error("open", uri.rest, number);
    // Nobody has opened it for reading yet.
    auto waited = wait_for(-1, 0, stop, std::chrono::steady_clock::now() + backoff.next());
    if (!waited) return waited.error();
  }
}

}  // namespace

Result<std::unique_ptr<Source>> open_file_source(const Uri& uri, const LinkOptions& options) {
  auto descriptor = open_path(uri, O_RDONLY, options.stop);
  if (!descriptor) return descriptor.error();
  ::posix_fadvise(descriptor->get(), 0, 0, POSIX_FADV_SEQUENTIAL);
  struct stat status {};
  bool is_fifo = ::fstat(descriptor->get(), &status) == 0 && S_ISFIFO(status.st_mode);
  return std::unique_ptr<Source>(new StreamSource(std::move(*descriptor), options, is_fifo));
}

Result<std::unique_ptr<Sink>> open_file_sink(const Uri& uri, const LinkOptions& options) {
  auto descriptor = open_path(uri, O_WRONLY | O_CREAT | O_TRUNC, options.stop);
  if (!descriptor) return descriptor.error();
  return make_stream_sink(std::move(*descriptor), uri, options);
}

}  // namespace hc::internal
