// SPDX-License-Identifier: Apache-2.0
#pragma once
// The transports, one pair of functions a scheme. Internal: link.cpp has the table of them.

#include <cstdint>
#include <memory>
#include <string_view>

#include <hc/link/link.h>

namespace hc::internal {

struct Transport {
  std::string_view scheme;
  std::string_view source_options, sink_options;  ///< names, with blanks between
  Result<std::unique_ptr<Source>> (*open_source)(const Uri&, const LinkOptions&);
  Result<std::unique_ptr<Sink>> (*open_sink)(const Uri&, const LinkOptions&);
};

Result<std::unique_ptr<Source>> open_stdin(const Uri&, const LinkOptions&);
Result<std::unique_ptr<Sink>> open_stdout(const Uri&, const LinkOptions&);
Result<std::unique_ptr<Source>> open_file_source(const Uri&, const LinkOptions&);
Result<std::unique_ptr<Sink>> open_file_sink(const Uri&, const LinkOptions&);
Result<std::unique_ptr<Source>> open_inproc_source(const Uri&, const LinkOptions&);
Result<std::unique_ptr<Sink>> open_inproc_sink(const Uri&, const LinkOptions&);
Result<std::unique_ptr<Source>> open_shm_source(const Uri&, const LinkOptions&);
Result<std::unique_ptr<Sink>> open_shm_sink(const Uri&, const LinkOptions&);

/// The ends of `dds:` links. They are in lib/dds, and null in programs that are linked without it.
[[gnu::weak]] Result<std::unique_ptr<Source>> open_dds_source(const Uri&, const LinkOptions&);
[[gnu::weak]] Result<std::unique_ptr<Sink>> open_dds_sink(const Uri&, const LinkOptions&);

/// Whether a `memory` is enough for shm, where it is all there is. Errors: Invalid.
Status check_shm_memory(const Uri& uri);

/// A URI's option that is a whole number from 0 to `most`. Errors: Invalid.
Result<std::int64_t> number_option(const Uri& uri, std::string_view key, std::int64_t default_value,
                                   std::int64_t most = 1'000'000'000);

}  // namespace hc::internal
