// SPDX-License-Identifier: Apache-2.0
#pragma once
// How chunks are compressed: by zstd in chunk_zstd.cpp; a build without libzstd has
// no_chunk_zstd.cpp in its place. Internal to mcap.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <hc/base/result.h>

namespace hc::internal {

class Compressor {
 public:
  virtual ~Compressor() = default;
  /// The bytes compressed; valid until it is called again.
  virtual std::span<const std::byte> compress(std::span<const std::byte> plain) = 0;
};

/// Null where this build lacks the library.
std::unique_ptr<Compressor> make_compressor(int level);

/// Errors: Malformed; Unsupported (this build lacks the library).
/// Cost: allocates `size` bytes, unless so few bytes cannot hold so many.
Result<std::vector<std::byte>> expand_zstd(std::span<const std::byte> bytes, std::uint64_t size);

}  // namespace hc::internal
