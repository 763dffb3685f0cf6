// SPDX-License-Identifier: Apache-2.0
#include <zstd.h>

#include <string>

#include <hc/base/check.h>
#include <record/mcap/chunk.h>

namespace hc::mcap {

std::vector<std::byte> compress_zstd(std::span<const std::byte> plain) {
  constexpr int kLevel = 1;  // the fastest
  std::vector<std::byte> bytes(ZSTD_compressBound(plain.size()));
  const std::size_t size =
      ZSTD_compress(bytes.data(), bytes.size(), plain.data(), plain.size(), kLevel);
  HC_CHECK(ZSTD_isError(size) == 0, ZSTD_getErrorName(size));
  bytes.resize(size);
  return bytes;
}

Result<std::vector<std::byte>> expand_zstd(std::span<const std::byte> bytes, std::uint64_t size) {
  // Maximum expansion ratio of zstd. Source: RFC 8878, 3.1.1.2; as in hc/compress.
  constexpr std::uint64_t kMaxExpansion = (std::uint64_t{128} << 10) / 4;
  if (size / kMaxExpansion > bytes.size())
    return Error{Code::Malformed, "MCAP chunk: too few compressed bytes"};
  std::vector<std::byte> plain(size);
  const std::size_t got = ZSTD_decompress(plain.data(), plain.size(), bytes.data(), bytes.size());
  if (ZSTD_isError(got) != 0)
    return Error{Code::Malformed, std::string("MCAP chunk: zstd: ") + ZSTD_getErrorName(got)};
  plain.resize(got);
  return plain;
}

}  // namespace hc::mcap
