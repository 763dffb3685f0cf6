// SPDX-License-Identifier: Apache-2.0
#include <record/mcap/chunk.h>

namespace hc::mcap {

std::vector<std::byte> compress_zstd(std::span<const std::byte>) {
  return {};
}

Result<std::vector<std::byte>> expand_zstd(std::span<const std::byte>, std::uint64_t) {
  return Error{Code::Unsupported,
               "MCAP chunk: this build cannot read zstd; install libzstd-dev and rebuild"};
}

}  // namespace hc::mcap
