// SPDX-License-Identifier: Apache-2.0
#pragma once
// Samples that are opaque bytes to Cyclone DDS, and types for their topics, without key and type
// information. Internal.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <memory>
#include <span>

#include <dds/dds.h>
#include <dds/ddsi/ddsi_serdata.h>
#include <dds/ddsi/ddsi_sertype.h>
#include <dds/ddsi/q_radmin.h>

namespace hc::dds {

/// A sample of what has been received in fragments, which may overlap.
template <class S>
ddsi_serdata* sample_of_fragments(const ddsi_sertype* type, ddsi_serdata_kind kind,
                                  const nn_rdata* fragment, std::size_t size) {
  auto sample = std::make_unique<S>(*type, kind);
  const auto payload_of = [](const nn_rdata* each) {
    return reinterpret_cast<const std::byte*>(
        NN_RMSG_PAYLOADOFF(each->rmsg, NN_RDATA_PAYLOAD_OFF(each)));
  };
  if (fragment == nullptr) return sample.release();
  std::byte* room = sample->allocate(size, {payload_of(fragment), fragment->maxp1 - fragment->min});
  std::uint32_t at = 0;
  for (; room != nullptr && fragment != nullptr; fragment = fragment->nextfrag) {
    const auto end = std::min<std::uint32_t>(fragment->maxp1, static_cast<std::uint32_t>(size));
    if (end <= at) continue;
    std::memcpy(room + at, payload_of(fragment) + at - fragment->min, end - at);
    at = end;
  }
  return sample.release();
}

/// A sample of consecutive pieces.
template <class S>
ddsi_serdata* sample_of_pieces(const ddsi_sertype* type, ddsi_serdata_kind kind,
                               ddsrt_msg_iovlen_t count, const ddsrt_iovec_t* pieces,
                               std::size_t size) {
  auto sample = std::make_unique<S>(*type, kind);
  if (count == 0) return sample.release();
  const std::span all(pieces, static_cast<std::size_t>(count));
  std::byte* room = sample->allocate(
      size, {static_cast<const std::byte*>(all[0].iov_base), std::size_t{all[0].iov_len}});
  std::size_t at = 0;
  for (const auto& piece : all) {
    if (room == nullptr || at >= size) break;
    const std::size_t length = std::min<std::size_t>(piece.iov_len, size - at);
    std::memcpy(room + at, piece.iov_base, length);
    at += length;
  }
  return sample.release();
}

/// Cyclone DDS's operations for samples of class S, which derives from ddsi_serdata and has
///
///     S(const ddsi_sertype& type, ddsi_serdata_kind kind);
///     std::byte* allocate(std::size_t size, std::span<const std::byte> first);
///     void copy(std::size_t at, std::span<std::byte> to) const;
///     std::size_t size;
///
/// allocate() provides memory for a received sample, given its first bytes; null discards it.
/// copy() copies a part, which may reach up to 3 bytes beyond the end since DDS sends words. The
/// caller sets `to_ser_ref` and `to_ser_unref`.
template <class S>
ddsi_serdata_ops byte_sample_ops() {
  static constexpr auto kWithoutBytes = [](const ddsi_sertype* type) -> ddsi_serdata* {
    return std::make_unique<S>(*type, SDK_KEY).release();
  };
  ddsi_serdata_ops ops{};
  ops.eqkey = [](const ddsi_serdata*, const ddsi_serdata*) { return true; };
  ops.get_size = [](const ddsi_serdata* data) {
    return static_cast<std::uint32_t>(static_cast<const S*>(data)->size);
  };
  ops.from_ser = sample_of_fragments<S>;
  ops.from_ser_iov = sample_of_pieces<S>;
  ops.from_keyhash = [](const ddsi_sertype* type, const ddsi_keyhash*) {
    return kWithoutBytes(type);
  };
  ops.from_sample = [](const ddsi_sertype* type, ddsi_serdata_kind, const void*) {
    return kWithoutBytes(type);  // samples are not made from structures
  };
  ops.to_ser = [](const ddsi_serdata* data, std::size_t at, std::size_t size, void* to) {
    static_cast<const S*>(data)->copy(at, {static_cast<std::byte*>(to), size});
  };
  ops.to_sample = [](const ddsi_serdata*, void*, void**, void*) { return false; };
  ops.to_untyped = [](const ddsi_serdata* data) {
    ddsi_serdata* untyped = kWithoutBytes(data->type);
    untyped->type = nullptr;
    return untyped;
  };
  ops.untyped_to_sample = [](const ddsi_sertype*, const ddsi_serdata*, void*, void**, void*) {
    return true;
  };
  ops.free = [](ddsi_serdata* data) { delete static_cast<S*>(data); };
  ops.print = [](const ddsi_sertype*, const ddsi_serdata* data, char* to, std::size_t size) {
    const auto bytes = static_cast<const S*>(data)->size;
    return static_cast<std::size_t>(std::snprintf(to, size, "%zu bytes", bytes));
  };
  ops.get_keyhash = [](const ddsi_serdata*, ddsi_keyhash* hash, bool) { *hash = {}; };
  return ops;
}

/// Cyclone DDS's operations for types of class T, derived from ddsi_sertype, which are all equal.
template <class T>
ddsi_sertype_ops byte_type_ops() {
  ddsi_sertype_ops ops{};
  ops.version = ddsi_sertype_v0;
  ops.free = [](ddsi_sertype* type) {
    ddsi_sertype_fini(type);
    delete static_cast<T*>(type);
  };
  ops.zero_samples = [](const ddsi_sertype*, void*, std::size_t) {};
  ops.realloc_samples = [](void**, const ddsi_sertype*, void*, std::size_t, std::size_t) {};
  ops.free_samples = [](const ddsi_sertype*, void**, std::size_t, dds_free_op_t) {};
  ops.equal = [](const ddsi_sertype*, const ddsi_sertype*) { return true; };
  ops.hash = [](const ddsi_sertype*) { return std::uint32_t{0}; };
  ops.derive_sertype = [](const ddsi_sertype* type, dds_data_representation_id_t,
                          dds_type_consistency_enforcement_qospolicy_t) {
    return const_cast<ddsi_sertype*>(type);  // bytes have one representation
  };
  return ops;
}

/// A type with these operations, which must outlive it.
template <class T>
std::unique_ptr<T> make_byte_type(const char* name, const ddsi_sertype_ops& type_ops,
                                  const ddsi_serdata_ops& sample_ops) {
  auto type = std::make_unique<T>();
  ddsi_sertype_init_flags(type.get(), name, &type_ops, &sample_ops,
                          DDSI_SERTYPE_FLAG_TOPICKIND_NO_KEY);
  type->allowed_data_representation = DDS_DATA_REPRESENTATION_FLAG_XCDR1;
  return type;
}

}  // namespace hc::dds
