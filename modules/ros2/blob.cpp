// SPDX-License-Identifier: Apache-2.0
#include "blob.h"

#include <algorithm>
#include <cstring>
#include <memory>
#include <vector>

#include <dds/byte_sample.h>

namespace {

struct BlobType : ddsi_sertype {
  std::size_t max_bytes = 0;
};

struct Blob : ddsi_serdata {
  Blob(const ddsi_sertype& of, ddsi_serdata_kind what) : ddsi_serdata{} {
    ddsi_serdata_init(this, &of, what);
  }
  /// Room for a message; null if it is too large.
  std::byte* allocate(std::size_t wanted, std::span<const std::byte> /*first*/) {
    is_too_large = wanted > static_cast<const BlobType*>(type)->max_bytes;
    if (is_too_large) return nullptr;
    size = wanted;
    bytes.resize((wanted + 3) / 4 * 4);  // sent in words of 4 bytes
    return bytes.data();
  }
  void copy(std::size_t at, std::span<std::byte> to) const {
    std::memcpy(to.data(), bytes.data() + at, to.size());
  }

  std::vector<std::byte> bytes;
  std::size_t size = 0;  // without padding
  bool is_too_large = false;
};

const Blob& blob_of(const ddsi_serdata* data) {
  return *static_cast<const Blob*>(data);
}

ddsi_serdata_ops make_blob_ops() {
  auto ops = hc::dds::byte_sample_ops<Blob>();
  ops.to_ser_ref = [](const ddsi_serdata* data, std::size_t at, std::size_t size,
                      ddsrt_iovec_t* to) {
    to->iov_base = const_cast<std::byte*>(blob_of(data).bytes.data() + at);
    to->iov_len = static_cast<ddsrt_iov_len_t>(size);
    return ddsi_serdata_ref(data);
  };
  ops.to_ser_unref = [](ddsi_serdata* data, const ddsrt_iovec_t*) { ddsi_serdata_unref(data); };
  return ops;
}

ddsi_sertype_ops make_type_ops() {
  auto ops = hc::dds::byte_type_ops<BlobType>();
  ops.equal = [](const ddsi_sertype* a, const ddsi_sertype* b) {
    return static_cast<const BlobType*>(a)->max_bytes == static_cast<const BlobType*>(b)->max_bytes;
  };
  return ops;
}

const ddsi_serdata_ops kBlobOps = make_blob_ops();
const ddsi_sertype_ops kTypeOps = make_type_ops();

}  // namespace

ddsi_sertype* make_blob_type(const std::string& name, std::size_t max_bytes) {
  auto type = hc::dds::make_byte_type<BlobType>(name.c_str(), kTypeOps, kBlobOps);
  type->max_bytes = max_bytes;
  return type.release();
}

ddsi_serdata* make_blob(const ddsi_sertype& type, const hc::ros::Pieces& pieces) {
  auto blob = std::make_unique<Blob>(type, SDK_DATA);
  if (std::byte* to = blob->allocate(pieces.size(), pieces.head)) {
    for (const auto piece : {pieces.head, pieces.body, pieces.tail})
      to = std::ranges::copy(piece, to).out;
  }
  return blob.release();
}

std::span<const std::byte> bytes_of(const ddsi_serdata& blob) {
  return std::span(blob_of(&blob).bytes).first(blob_of(&blob).size);
}

bool is_too_large(const ddsi_serdata& blob) {
  return blob_of(&blob).is_too_large;
}
