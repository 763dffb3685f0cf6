// SPDX-License-Identifier: Apache-2.0
// `-`: standard input and output, so that modules work in a shell pipe. `file:PATH`: a file, FIFO
// or device; the same bytes as over a network. file_sink.cpp writes them.
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <hc/base/backoff.h>
#include <hc/link/stream/ends.h>
#include <hc/link/stream/source.h>
#include <hc/link/transports.h>

namespace hc::internal {
namespace {

/// Enlarges a pipe beyond the kernel's 64 KiB; no effect on other files.
void widen_pipe(int descriptor) {
  constexpr int kPipeBytes = 1 << 20;
  ::fcntl(descriptor, F_SETPIPE_SZ, kPipeBytes);
}

/// A non-blocking descriptor of the file that `number` refers to, which stays as it is for other
/// processes that share it. The descriptor of a socket may still block.
Result<Descriptor> reopen_without_waiting(int number, int access_mode) {
  struct stat status {};
  HC_TRY(system_call("fstat", "", [&] { return ::fstat(number, &status); }));
  if (S_ISFIFO(status.st_mode) || S_ISCHR(status.st_mode)) {
    // Opened again, since flags of `number` are shared with the shell and others.
    std::string path = "/proc/self/fd/" + std::to_string(number);
    Descriptor own(::open(path.c_str(), access_mode | O_NONBLOCK | O_CLOEXEC | O_NOCTTY));
    if (own) {
      widen_pipe(own.get());
      return own;
    }
  }
  return open_descriptor("dup", "", [&] { return ::fcntl(number, F_DUPFD_CLOEXEC, 0); });
}

}  // namespace

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
    // A FIFO that is not yet open for reading.
    HC_TRY(wait_for(-1, 0, stop, std::chrono::steady_clock::now() + backoff.next()));
  }
}

Result<std::unique_ptr<Source>> open_stdin(const Uri&, const LinkOptions& options) {
  auto descriptor = HC_TRY(reopen_without_waiting(STDIN_FILENO, O_RDONLY));
  return std::unique_ptr<Source>(new StreamSource({std::move(descriptor)}, options));
}

Result<std::unique_ptr<Sink>> open_stdout(const Uri& uri, const LinkOptions& options) {
  auto descriptor = HC_TRY(reopen_without_waiting(STDOUT_FILENO, O_WRONLY));
  return make_stream_sink({std::move(descriptor)}, uri, options);
}

Result<std::unique_ptr<Source>> open_file_source(const Uri& uri, const LinkOptions& options) {
  auto descriptor = HC_TRY(open_path(uri, O_RDONLY, options.stop));
  ::posix_fadvise(descriptor.get(), 0, 0, POSIX_FADV_SEQUENTIAL);
  struct stat status {};
  bool is_fifo = ::fstat(descriptor.get(), &status) == 0 && S_ISFIFO(status.st_mode);
  return std::unique_ptr<Source>(new StreamSource({std::move(descriptor)}, options, is_fifo));
}

}  // namespace hc::internal
