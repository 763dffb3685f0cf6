// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <bit>
#include <cstdio>
#include <cstring>
#include <string_view>
#include <vector>

#include <dds/ddsi/q_radmin.h>

#include <dds/sample.h>
#include <hc/mtp/framing.h>
#include <hc/mtp/stream_reader.h>

namespace hc::dds {
namespace {

constexpr std::size_t kPrelude = 8;  // encapsulation, and the number of bytes

std::size_t in_words(std::size_t size) {
  return (size + 3) / 4 * 4;
}

/// A sample that is sent: the frame and the header's line are ours, the elements the message's.
/// Or one that has come: all its bytes are the elements.
struct MessageSample : ddsi_serdata {
  MessageSample(const ddsi_sertype& of, ddsi_serdata_kind what) : ddsi_serdata{} {
    ddsi_serdata_init(this, &of, what);
  }

  /// Copies what is in a part of it; behind its end there are zeros.
  void copy(std::size_t at, std::span<std::byte> to) const {
    for (const auto piece : {std::span<const std::byte>(begin), elements, end}) {
      const std::size_t skipped = std::min(at, piece.size());
      const std::size_t count = std::min(piece.size() - skipped, to.size());
      if (count > 0) std::memcpy(to.data(), piece.data() + skipped, count);
      to = to.subspan(count);
      at -= skipped;
    }
    std::ranges::fill(to, std::byte{0});
  }

  std::size_t size = 0;
  std::vector<std::byte> begin;  // of one that is sent
  std::span<const std::byte> elements, end;
  std::shared_ptr<const void> owner;
  SharedBytes bytes;  // of one that has come, aligned for its message
};

const MessageSample& own(const ddsi_serdata* sample) {
  return *static_cast<const MessageSample*>(sample);
}

/// Room for a sample of so many bytes, in which what follows the first line feed is aligned.
void allot(MessageSample& sample, std::size_t size, std::string_view start) {
  constexpr std::size_t kAlignment = 64;
  sample.size = size;
  const auto feed = start.find('\n');
  const std::size_t elements = feed == std::string_view::npos ? 0 : feed + 1;
  const std::size_t offset = (kAlignment - elements % kAlignment) % kAlignment;
  auto room = allocate_bytes(size + offset);
  sample.bytes = SharedBytes(room, room.get() + offset);
  sample.elements = {sample.bytes.get(), size};
}

std::string_view text_of(const void* bytes, std::size_t size) {
  return {static_cast<const char*>(bytes), std::min(size, kPrelude + kMaxHeaderBytes)};
}

ddsi_serdata* from_fragments(const ddsi_sertype* type, ddsi_serdata_kind kind,
                             const nn_rdata* fragment, std::size_t size) {
  auto sample = std::make_unique<MessageSample>(*type, kind);
  const auto payload_of = [](const nn_rdata* each) {
    return NN_RMSG_PAYLOADOFF(each->rmsg, NN_RDATA_PAYLOAD_OFF(each));
  };
  if (fragment == nullptr) return sample.release();
  allot(*sample, size, text_of(payload_of(fragment), fragment->maxp1 - fragment->min));
  std::uint32_t at = 0;  // fragments may overlap
  for (; fragment != nullptr; fragment = fragment->nextfrag) {
    const auto end = std::min<std::uint32_t>(fragment->maxp1, static_cast<std::uint32_t>(size));
    if (end <= at) continue;
    std::memcpy(sample->bytes.get() + at, payload_of(fragment) + at - fragment->min, end - at);
    at = end;
  }
  return sample.release();
}

ddsi_serdata* from_vector(const ddsi_sertype* type, ddsi_serdata_kind kind,
                          ddsrt_msg_iovlen_t count, const ddsrt_iovec_t* pieces, std::size_t size) {
  auto sample = std::make_unique<MessageSample>(*type, kind);
  if (count == 0) return sample.release();
  allot(*sample, size, text_of(pieces[0].iov_base, pieces[0].iov_len));
  std::size_t at = 0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(count) && at < size; ++i) {
    const std::size_t length = std::min<std::size_t>(pieces[i].iov_len, size - at);
    std::memcpy(sample->bytes.get() + at, pieces[i].iov_base, length);
    at += length;
  }
  return sample.release();
}

ddsi_serdata* without_bytes(const ddsi_sertype* type) {
  return std::make_unique<MessageSample>(*type, SDK_KEY).release();
}

/// A part of a sample where it is, if it is of one piece; else a copy, until refer_no_more().
ddsi_serdata* refer(const ddsi_serdata* data, std::size_t at, std::size_t size, ddsrt_iovec_t* to) {
  const auto& sample = own(data);
  const std::size_t begin = sample.begin.size();
  to->iov_len = static_cast<ddsrt_iov_len_t>(size);
  if (size > 0 && at >= begin && at + size <= begin + sample.elements.size()) {
    to->iov_base = const_cast<std::byte*>(sample.elements.data() + (at - begin));
  } else {
    auto copy = std::make_unique<std::byte[]>(size);
    sample.copy(at, {copy.get(), size});
    to->iov_base = copy.release();
  }
  return ddsi_serdata_ref(data);
}

void refer_no_more(ddsi_serdata* data, const ddsrt_iovec_t* reference) {
  const auto elements = own(data).elements;
  const auto* base = static_cast<const std::byte*>(reference->iov_base);
  const bool is_inside = !elements.empty() && std::less_equal<>()(elements.data(), base) &&
                         std::less<>()(base, elements.data() + elements.size());
  if (!is_inside) delete[] base;
  ddsi_serdata_unref(data);
}

ddsi_serdata_ops make_data_ops() {
  ddsi_serdata_ops ops{};
  ops.eqkey = [](const ddsi_serdata*, const ddsi_serdata*) { return true; };
  ops.get_size = [](const ddsi_serdata* data) {
    return static_cast<std::uint32_t>(own(data).size);
  };
  ops.from_ser = from_fragments;
  ops.from_ser_iov = from_vector;
  ops.from_keyhash = [](const ddsi_sertype* type, const ddsi_keyhash*) {
    return without_bytes(type);
  };
  ops.from_sample = [](const ddsi_sertype* type, ddsi_serdata_kind, const void*) {
    return without_bytes(type);  // samples are made by make_sample() alone
  };
  ops.to_ser = [](const ddsi_serdata* data, std::size_t at, std::size_t size, void* to) {
    own(data).copy(at, {static_cast<std::byte*>(to), size});
  };
  ops.to_ser_ref = refer;
  ops.to_ser_unref = refer_no_more;
  ops.to_sample = [](const ddsi_serdata*, void*, void**, void*) { return false; };
  ops.to_untyped = [](const ddsi_serdata* data) {
    ddsi_serdata* untyped = without_bytes(data->type);
    untyped->type = nullptr;
    return untyped;
  };
  ops.untyped_to_sample = [](const ddsi_sertype*, const ddsi_serdata*, void*, void**, void*) {
    return true;
  };
  ops.free = [](ddsi_serdata* data) { delete static_cast<MessageSample*>(data); };
  ops.print = [](const ddsi_sertype*, const ddsi_serdata* data, char* to, std::size_t size) {
    return static_cast<std::size_t>(std::snprintf(to, size, "%zu bytes", own(data).size));
  };
  ops.get_keyhash = [](const ddsi_serdata*, ddsi_keyhash* hash, bool) { *hash = {}; };
  return ops;
}

ddsi_sertype_ops make_type_ops() {
  ddsi_sertype_ops ops{};
  ops.version = ddsi_sertype_v0;
  ops.free = [](ddsi_sertype* type) {
    ddsi_sertype_fini(type);
    delete type;
  };
  ops.zero_samples = [](const ddsi_sertype*, void*, std::size_t) {};
  ops.realloc_samples = [](void**, const ddsi_sertype*, void*, std::size_t, std::size_t) {};
  ops.free_samples = [](const ddsi_sertype*, void**, std::size_t, dds_free_op_t) {};
  ops.equal = [](const ddsi_sertype*, const ddsi_sertype*) { return true; };
  ops.hash = [](const ddsi_sertype*) { return std::uint32_t{0}; };
  ops.derive_sertype = [](const ddsi_sertype* type, dds_data_representation_id_t,
                          dds_type_consistency_enforcement_qospolicy_t) {
    return const_cast<ddsi_sertype*>(type);  // bytes are bytes
  };
  return ops;
}

const ddsi_serdata_ops kDataOps = make_data_ops();
const ddsi_sertype_ops kTypeOps = make_type_ops();

Error no_message(const std::string& why) {
  return {Code::Malformed, "it is no sequence of octets: " + why};
}

/// The octets of a sample's sequence.
Result<std::span<const std::byte>> sequence_of(const MessageSample& sample) {
  // CDR, of one byte order or the other; its options are how much padding there is.
  constexpr unsigned char kCdrBig = 0, kCdrLittle = 1;
  if (sample.kind != SDK_DATA || sample.size < kPrelude) return no_message("it has no bytes");
  std::array<unsigned char, kPrelude> prelude{};
  std::memcpy(prelude.data(), sample.bytes.get(), kPrelude);
  if (prelude[0] != 0 || (prelude[1] != kCdrBig && prelude[1] != kCdrLittle))
    return no_message("it is not in CDR");
  std::uint32_t count = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t shift = prelude[1] == kCdrLittle ? 8 * i : 8 * (3 - i);
    count |= static_cast<std::uint32_t>(prelude[4 + i]) << shift;
  }
  if (count > sample.size - kPrelude || sample.size - kPrelude - count > 3)
    return no_message("it says " + std::to_string(count) + " and has " +
                      std::to_string(sample.size - kPrelude));
  return std::span<const std::byte>(sample.bytes.get() + kPrelude, count);
}

Error surplus() {
  return {Code::Malformed, "its message is followed by more"};
}
Error cut() {
  return {Code::Truncated, "it ends inside its message"};
}

/// By way of a stream, which copies.
Result<Message> read_rows(std::span<const std::byte> octets, const Limits& limits) {
  StreamReader reader(limits);
  Message message;
  while (!octets.empty()) {
    const auto space = reader.space();
    const std::size_t count = std::min(space.size(), octets.size());
    std::memcpy(space.data(), octets.data(), count);
    reader.commit(count);
    octets = octets.subspan(count);
    auto got = reader.next(message);
    if (!got) return got.error();
    if (!*got) continue;
    if (!octets.empty() || !reader.finish()) return surplus();
    return message;
  }
  return cut();
}

}  // namespace

ddsi_sertype* make_type() {
  auto type = std::make_unique<ddsi_sertype>();
  ddsi_sertype_init_flags(type.get(), kTypeName, &kTypeOps, &kDataOps,
                          DDSI_SERTYPE_FLAG_TOPICKIND_NO_KEY);
  type->allowed_data_representation = DDS_DATA_REPRESENTATION_FLAG_XCDR1;
  return type.release();
}

Sample make_sample(const ddsi_sertype& type, const Pieces& pieces, const Message& message) {
  auto sample = std::make_unique<MessageSample>(type, SDK_DATA);
  const auto& [head, elements, end] = pieces;
  const auto count = static_cast<std::uint32_t>(head.size() + elements.size() + end.size());
  sample->size = kPrelude + count;
  const auto padding = static_cast<unsigned char>(in_words(sample->size) - sample->size);
  std::array<unsigned char, kPrelude> prelude = {0, 1, 0, padding};
  for (std::size_t i = 0; i < 4; ++i) prelude[4 + i] = static_cast<unsigned char>(count >> 8 * i);
  constexpr std::size_t kMostCopied = 4096;  // a piece more costs as much
  const bool is_copied = elements.size() <= kMostCopied;
  auto& begin = sample->begin;
  begin.reserve(kPrelude + head.size() + (is_copied ? elements.size() + end.size() : 0));
  const auto* prelude_bytes = reinterpret_cast<const std::byte*>(prelude.data());
  begin.assign(prelude_bytes, prelude_bytes + kPrelude);
  begin.insert(begin.end(), head.begin(), head.end());
  if (is_copied) {
    begin.insert(begin.end(), elements.begin(), elements.end());
    begin.insert(begin.end(), end.begin(), end.end());
  } else {
    const Message kept = message.keep();
    sample->elements = kept.elements;
    sample->owner = kept.owner;
    sample->end = end;  // a constant
  }
  return Sample(sample.release());
}

Sample make_end(const ddsi_sertype& type) {
  auto sample = std::make_unique<MessageSample>(type, SDK_DATA);
  sample->size = kPrelude;
  sample->begin = {std::byte{0}, std::byte{1}, std::byte{0}, std::byte{0},
                   std::byte{0}, std::byte{0}, std::byte{0}, std::byte{0}};
  return Sample(sample.release());
}

std::uint64_t octets_of(const ddsi_serdata& sample) {
  const auto size = own(&sample).size;
  return size > kPrelude ? size - kPrelude : 0;
}

Result<Message> read_message(const ddsi_serdata& data, const Limits& limits,
                             internal::HeaderMemo& memo) {
  const auto& sample = own(&data);
  auto octets = sequence_of(sample);
  if (!octets) return octets.error();
  std::string_view text(reinterpret_cast<const char*>(octets->data()), octets->size());
  auto line = internal::read_header_line(text, limits, 0, memo);
  if (!line) return line.error();
  if (line->bytes == 0) return cut();
  if (internal::has_rows(line->header)) return read_rows(*octets, limits);
  std::size_t at = line->bytes;
  std::uint64_t length = line->header.element_bytes();
  if (internal::is_compressed(line->header)) {
    auto part = internal::read_length_line(text.substr(at), limits, at);
    if (!part) return part.error();
    if (part->bytes == 0) return cut();
    at += part->bytes;
    length = part->length;
  }
  if (length > text.size() - at) return cut();
  auto closing = internal::read_closing(line->header, text.substr(at + length), at + length);
  if (!closing) return closing.error();
  if (*closing == 0) return cut();
  if (at + length + *closing != text.size()) return surplus();
  Message message{line->header, octets->subspan(at, length), sample.bytes, at};
  const std::size_t scalar =
      internal::is_compressed(line->header) ? 1 : size_of(line->header.info.scalar);
  if (reinterpret_cast<std::uintptr_t>(message.elements.data()) % scalar != 0) {
    message.owner.reset();  // a stranger's, of fragments inside the header
    message = message.keep();
  }
  return message;
}

}  // namespace hc::dds
