// SPDX-License-Identifier: Apache-2.0
#include "blob.h"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <memory>
#include <vector>

#include <dds/ddsi/q_radmin.h>

namespace {

struct BlobType : ddsi_sertype {
  std::size_t max_bytes = 0;
};

struct Blob : ddsi_serdata {
  Blob(const ddsi_sertype& of, ddsi_serdata_kind what) : ddsi_serdata{} {
    ddsi_serdata_init(this, &of, what);
  }
  /// Room for a message, if it is not too large.
  bool allot(std::size_t wanted) {
    is_too_large = wanted > static_cast<const BlobType*>(type)->max_bytes;
    if (is_too_large) return false;
    size = wanted;
    bytes.resize((wanted + 3) / 4 * 4);  // they are sent in words
    return true;
  }

  std::vector<std::byte> bytes;
  std::size_t size = 0;  // without what fills the last word
  bool is_too_large = false;
};

const Blob& blob_of(const ddsi_serdata* data) {
  return *static_cast<const Blob*>(data);
}

ddsi_serdata* from_fragments(const ddsi_sertype* type, ddsi_serdata_kind kind,
                             const nn_rdata* fragment, std::size_t size) {
  auto blob = std::make_unique<Blob>(*type, kind);
  if (!blob->allot(size)) return blob.release();
  std::uint32_t at = 0;  // fragments may overlap
  for (; fragment != nullptr; fragment = fragment->nextfrag) {
    const auto end = std::min<std::uint32_t>(fragment->maxp1, static_cast<std::uint32_t>(size));
    if (end <= at) continue;
    const auto* payload = NN_RMSG_PAYLOADOFF(fragment->rmsg, NN_RDATA_PAYLOAD_OFF(fragment));
    std::memcpy(blob->bytes.data() + at, payload + at - fragment->min, end - at);
    at = end;
  }
  return blob.release();
}

ddsi_serdata* from_vector(const ddsi_sertype* type, ddsi_serdata_kind kind,
                          ddsrt_msg_iovlen_t count, const ddsrt_iovec_t* pieces, std::size_t size) {
  auto blob = std::make_unique<Blob>(*type, kind);
  if (!blob->allot(size)) return blob.release();
  std::size_t at = 0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(count) && at < size; ++i) {
    const std::size_t length = std::min<std::size_t>(pieces[i].iov_len, size - at);
    std::memcpy(blob->bytes.data() + at, pieces[i].iov_base, length);
    at += length;
  }
  return blob.release();
}

ddsi_serdata* without_bytes(const ddsi_sertype* type) {
  return std::make_unique<Blob>(*type, SDK_KEY).release();
}

ddsi_serdata_ops make_data_ops() {
  ddsi_serdata_ops ops{};
  ops.eqkey = [](const ddsi_serdata*, const ddsi_serdata*) { return true; };
  ops.get_size = [](const ddsi_serdata* data) {
    return static_cast<std::uint32_t>(blob_of(data).size);
  };
  ops.from_ser = from_fragments;
  ops.from_ser_iov = from_vector;
  ops.from_keyhash = [](const ddsi_sertype* type, const ddsi_keyhash*) {
    return without_bytes(type);
  };
  ops.from_sample = [](const ddsi_sertype* type, ddsi_serdata_kind, const void*) {
    return without_bytes(type);  // messages are made by make_blob() alone
  };
  ops.to_ser = [](const ddsi_serdata* data, std::size_t at, std::size_t size, void* to) {
    std::memcpy(to, blob_of(data).bytes.data() + at, size);
  };
  ops.to_ser_ref = [](const ddsi_serdata* data, std::size_t at, std::size_t size,
                      ddsrt_iovec_t* to) {
    to->iov_base = const_cast<std::byte*>(blob_of(data).bytes.data() + at);
    to->iov_len = static_cast<ddsrt_iov_len_t>(size);
    return ddsi_serdata_ref(data);
  };
  ops.to_ser_unref = [](ddsi_serdata* data, const ddsrt_iovec_t*) { ddsi_serdata_unref(data); };
  ops.to_sample = [](const ddsi_serdata*, void*, void**, void*) { return false; };
  ops.to_untyped = [](const ddsi_serdata* data) {
    ddsi_serdata* untyped = without_bytes(data->type);
    untyped->type = nullptr;
    return untyped;
  };
  ops.untyped_to_sample = [](const ddsi_sertype*, const ddsi_serdata*, void*, void**, void*) {
    return true;
  };
  ops.free = [](ddsi_serdata* data) { delete static_cast<Blob*>(data); };
  ops.print = [](const ddsi_sertype*, const ddsi_serdata* data, char* to, std::size_t size) {
    return static_cast<std::size_t>(std::snprintf(to, size, "%zu bytes", blob_of(data).size));
  };
  ops.get_keyhash = [](const ddsi_serdata*, ddsi_keyhash* hash, bool) { *hash = {}; };
  return ops;
}

ddsi_sertype_ops make_type_ops() {
  ddsi_sertype_ops ops{};
  ops.version = ddsi_sertype_v0;
  ops.free = [](ddsi_sertype* type) {
    ddsi_sertype_fini(type);
    delete static_cast<BlobType*>(type);
  };
  ops.zero_samples = [](const ddsi_sertype*, void*, std::size_t) {};
  ops.realloc_samples = [](void**, const ddsi_sertype*, void*, std::size_t, std::size_t) {};
  ops.free_samples = [](const ddsi_sertype*, void**, std::size_t, dds_free_op_t) {};
  ops.equal = [](const ddsi_sertype* a, const ddsi_sertype* b) {
    return static_cast<const BlobType*>(a)->max_bytes == static_cast<const BlobType*>(b)->max_bytes;
  };
  ops.hash = [](const ddsi_sertype*) { return std::uint32_t{0}; };
  ops.derive_sertype = [](const ddsi_sertype* type, dds_data_representation_id_t,
                          dds_type_consistency_enforcement_qospolicy_t) {
    return const_cast<ddsi_sertype*>(type);  // bytes are bytes
  };
  return ops;
}

const ddsi_serdata_ops kDataOps = make_data_ops();
const ddsi_sertype_ops kTypeOps = make_type_ops();

}  // namespace

ddsi_sertype* make_blob_type(const std::string& name, std::size_t max_bytes) {
  auto type = std::make_unique<BlobType>();
  type->max_bytes = max_bytes;
  ddsi_sertype_init_flags(type.get(), name.c_str(), &kTypeOps, &kDataOps,
                          DDSI_SERTYPE_FLAG_TOPICKIND_NO_KEY);
  type->allowed_data_representation = DDS_DATA_REPRESENTATION_FLAG_XCDR1;
  return type.release();
}

ddsi_serdata* make_blob(const ddsi_sertype& type, const hc::ros::Pieces& pieces) {
  auto blob = std::make_unique<Blob>(type, SDK_DATA);
  if (blob->allot(pieces.size())) {
    auto to = blob->bytes.begin();
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
