// SPDX-License-Identifier: Apache-2.0
#pragma once
// Opens links that do not use sockets; for the others see stream/ends.h. Internal.

#include <memory>

#include <hc/link/link.h>
#include <hc/os/descriptor.h>

namespace hc::internal {

/// Opens a file without blocking on the other end of a FIFO, so that `stop` can end the wait.
Result<Descriptor> open_path(const Uri& uri, int flags, int stop);

Result<std::unique_ptr<Source>> open_stdin(const Uri&, const LinkOptions&);
Result<std::unique_ptr<Sink>> open_stdout(const Uri&, const LinkOptions&);
Result<std::unique_ptr<Source>> open_file_source(const Uri&, const LinkOptions&);
Result<std::unique_ptr<Sink>> open_file_sink(const Uri&, const LinkOptions&);
Result<std::unique_ptr<Source>> open_inproc_source(const Uri&, const LinkOptions&);
Result<std::unique_ptr<Sink>> open_inproc_sink(const Uri&, const LinkOptions&);
Result<std::unique_ptr<Source>> open_shm_source(const Uri&, const LinkOptions&);
Result<std::unique_ptr<Sink>> open_shm_sink(const Uri&, const LinkOptions&);

/// Checks that `memory` is sufficient for shm. Errors: Invalid.
Status check_shm_memory(const Uri& uri);

}  // namespace hc::internal
