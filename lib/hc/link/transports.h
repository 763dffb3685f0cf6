// SPDX-License-Identifier: Apache-2.0
#pragma once
// Opens the ends of links that do not use sockets; stream/ends.h has the others. Internal.

#include <memory>

#include <hc/link/link.h>
#include <hc/os/descriptor.h>

namespace hc::internal {

/// Opens a file without waiting for the other end of a FIFO, which a signal to stop could not end.
Result<Descriptor> open_path(const Uri& uri, int flags, int stop);

Result<std::unique_ptr<Source>> open_stdin(const Uri&, const LinkOptions&);
Result<std::unique_ptr<Sink>> open_stdout(const Uri&, const LinkOptions&);
Result<std::unique_ptr<Source>> open_file_source(const Uri&, const LinkOptions&);
Result<std::unique_ptr<Sink>> open_file_sink(const Uri&, const LinkOptions&);
Result<std::unique_ptr<Source>> open_inproc_source(const Uri&, const LinkOptions&);
Result<std::unique_ptr<Sink>> open_inproc_sink(const Uri&, const LinkOptions&);
Result<std::unique_ptr<Source>> open_shm_source(const Uri&, const LinkOptions&);
Result<std::unique_ptr<Sink>> open_shm_sink(const Uri&, const LinkOptions&);

/// Whether a `memory` is enough for shm, where it is all there is. Errors: Invalid.
Status check_shm_memory(const Uri& uri);

}  // namespace hc::internal
