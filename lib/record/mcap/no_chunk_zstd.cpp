// SPDX-License-Identifier: Apache-2.0
#include <record/mcap/chunk_codec.h>

namespace hc::internal {

std::unique_ptr<Compressor> make_compressor(int) {
  return nullptr;
}

Result<std::vector<std::byte>> expand_zstd(std::span<const std::byte>, std::uint64_t) {
  return Error{Code::Unsupported,
               "MCAP chunk: this build cannot read zstd; install libzstd-dev and build again"};
}

}  // namespace hc::internal
