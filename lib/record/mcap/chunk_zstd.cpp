// SPDX-License-Identifier: Apache-2.0
#include <zstd.h>

#include <string>

#include <hc/base/check.h>
#include <record/mcap/chunk_codec.h>

namespace hc::internal {
namespace {

/// Most bytes that one byte of zstd can stand for. Source: RFC 8878, 3.1.1.2; as in compress.
constexpr std::uint64_t kMaxExpansion = (std::uint64_t{128} << 10) / 4;

class ZstdCompressor : public Compressor {
 public:
  explicit ZstdCompressor(int level) : context_(ZSTD_createCCtx()) {
    HC_CHECK(context_ != nullptr);
    ZSTD_CCtx_setParameter(context_, ZSTD_c_compressionLevel, level);
  }
  ZstdCompressor(const ZstdCompressor&) = delete;
  ZstdCompressor& operator=(const ZstdCompressor&) = delete;
  ~ZstdCompressor() override { ZSTD_freeCCtx(context_); }

  std::span<const std::byte> compress(std::span<const std::byte> plain) override {
    room_.resize(ZSTD_compressBound(plain.size()));
    const std::size_t size =
        ZSTD_compress2(context_, room_.data(), room_.size(), plain.data(), plain.size());
    HC_CHECK(ZSTD_isError(size) == 0, ZSTD_getErrorName(size));
    return std::span<const std::byte>(room_).first(size);
  }

 private:
  ZSTD_CCtx* context_;
  std::vector<std::byte> room_;
};

}  // namespace

std::unique_ptr<Compressor> make_compressor(int level) {
  return std::make_unique<ZstdCompressor>(level);
}

Result<std::vector<std::byte>> expand_zstd(std::span<const std::byte> bytes, std::uint64_t size) {
  if (size / kMaxExpansion > bytes.size())
    return Error{Code::Malformed, "MCAP chunk: it is too short for what it promises"};
  std::vector<std::byte> plain(size);
  const std::size_t got = ZSTD_decompress(plain.data(), plain.size(), bytes.data(), bytes.size());
  if (ZSTD_isError(got) != 0)
    return Error{Code::Malformed, std::string("MCAP chunk: zstd: ") + ZSTD_getErrorName(got)};
  plain.resize(got);
  return plain;
}

}  // namespace hc::internal
