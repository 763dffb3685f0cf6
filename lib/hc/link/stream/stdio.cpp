// SPDX-License-Identifier: Apache-2.0
// `-`: standard input and output, so that modules work in a shell pipe.
#include <fcntl.h>
#include <unistd.h>

#include <hc/link/stream/sink.h>
#include <hc/link/stream/source.h>
#include <hc/link/transports.h>

namespace hc::internal {

Result<std::unique_ptr<Source>> open_stdin(const Uri&, const LinkOptions& options) {
  auto descriptor = reopen_without_waiting(STDIN_FILENO, O_RDONLY);
  if (!descriptor) return descriptor.error();
  return std::unique_ptr<Source>(new StreamSource(std::move(*descriptor), options));
}

Result<std::unique_ptr<Sink>> open_stdout(const Uri& uri, const LinkOptions& options) {
  auto descriptor = reopen_without_waiting(STDOUT_FILENO, O_WRONLY);
  if (!descriptor) return descriptor.error();
  return make_stream_sink(std::move(*descriptor), uri, options);
}

}  // namespace hc::internal
