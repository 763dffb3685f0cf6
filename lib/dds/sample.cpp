// SPDX-License-Identifier: Apache-2.0
#include <dds/sample.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <functional>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include <dds/byte_sample.h>
#include <hc/mtp/framing.h>
#include <hc/mtp/stream_reader.h>

namespace hc::dds {
namespace {

constexpr std::size_t kPrelude = 8;  // encapsulation header and sequence length [byte]

/// A sample to be sent has the prelude and the header line in `begin` and the elements in
/// `elements`, or everything in `begin` if they are copied; a received one has all in `elements`.
struct MessageSample : ddsi_serdata {
  MessageSample(const ddsi_sertype& of, ddsi_serdata_kind what) : ddsi_serdata{} {
    ddsi_serdata_init(this, &of, what);
  }

  /// Allocates memory in which the bytes after the first line feed are aligned.
  std::byte* allocate(std::size_t wanted, std::span<const std::byte> first) {
    constexpr std::size_t kAlignment = 64;
    size = wanted;
    const std::string_view start(reinterpret_cast<const char*>(first.data()),
                                 std::min(first.size(), kPrelude + kMaxHeaderBytes));
    const auto feed = start.find('\n');
    const std::size_t header = feed == std::string_view::npos ? 0 : feed + 1;
    const std::size_t offset = (kAlignment - header % kAlignment) % kAlignment;
    auto room = allocate_bytes(size + offset);
    bytes = SharedBytes(room, room.get() + offset);
    elements = {bytes.get(), size};
    return room.get() + offset;
  }

  /// Copies a part of the sample; zeros beyond its end.
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

  /// Writes the encapsulation header and the sequence length, according to `size`.
  void write_prelude() {
    const auto count = static_cast<std::uint32_t>(size - kPrelude);
    const auto padding = static_cast<unsigned char>(-size % 4);
    std::array<unsigned char, kPrelude> prelude = {0, 1, 0, padding};
    for (std::size_t i = 0; i < 4; ++i) prelude[4 + i] = static_cast<unsigned char>(count >> 8 * i);
    std::memcpy(begin.data(), prelude.data(), kPrelude);
  }

  std::size_t size = 0;
  std::vector<std::byte> begin;
  std::span<const std::byte> elements, end;
  std::shared_ptr<const void> owner;  // of `elements` of a sample to be sent
  SharedBytes bytes;                  // of `elements` of a received sample
};

const MessageSample& own(const ddsi_serdata* sample) {
  return *static_cast<const MessageSample*>(sample);
}

/// A part of a sample in place if it is contiguous, else a copy, until release_part().
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

void release_part(ddsi_serdata* data, const ddsrt_iovec_t* reference) {
  const auto elements = own(data).elements;
  const auto* base = static_cast<const std::byte*>(reference->iov_base);
  const bool is_inside = !elements.empty() && std::less_equal<>()(elements.data(), base) &&
                         std::less<>()(base, elements.data() + elements.size());
  if (!is_inside) delete[] base;
  ddsi_serdata_unref(data);
}

ddsi_serdata_ops make_sample_ops() {
  auto ops = byte_sample_ops<MessageSample>();
  ops.to_ser_ref = refer;
  ops.to_ser_unref = release_part;
  return ops;
}

const ddsi_serdata_ops kSampleOps = make_sample_ops();
const ddsi_sertype_ops kTypeOps = byte_type_ops<ddsi_sertype>();

Error not_octets(const std::string& why) {
  return {Code::Malformed, "not a sequence of octets: " + why};
}

Result<std::span<const std::byte>> sequence_of(const MessageSample& sample) {
  // CDR in either byte order; the options hold the number of padding bytes.
  constexpr unsigned char kCdrBig = 0, kCdrLittle = 1;
  if (sample.kind != SDK_DATA || sample.size < kPrelude) return not_octets("too short");
  std::array<unsigned char, kPrelude> prelude{};
  std::memcpy(prelude.data(), sample.bytes.get(), kPrelude);
  if (prelude[0] != 0 || (prelude[1] != kCdrBig && prelude[1] != kCdrLittle))
    return not_octets("not in CDR");
  std::uint32_t count = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t shift = prelude[1] == kCdrLittle ? 8 * i : 8 * (3 - i);
    count |= static_cast<std::uint32_t>(prelude[4 + i]) << shift;
  }
  if (count > sample.size - kPrelude || sample.size - kPrelude - count > 3)
    return not_octets("length " + std::to_string(count) + ", but " +
                      std::to_string(sample.size - kPrelude) + " bytes");
  return std::span<const std::byte>(sample.bytes.get() + kPrelude, count);
}

/// The message in the octets, if there is exactly one, whose elements can be used in place.
std::optional<Message> view_one(std::span<const std::byte> octets, const Limits& limits,
                                internal::HeaderMemo& memo) {
  const std::string_view text(reinterpret_cast<const char*>(octets.data()), octets.size());
  auto line = internal::read_header_line(text, limits, 0, memo);
  if (!line || line->bytes == 0 || internal::has_rows(line->header)) return std::nullopt;
  const Header& header = line->header;
  std::size_t at = line->bytes;
  std::uint64_t length = header.element_bytes();
  if (internal::is_compressed(header)) {
    auto part = internal::read_length_line(text.substr(at), limits, at);
    if (!part || part->bytes == 0) return std::nullopt;
    at += part->bytes;
    length = part->length;
  }
  if (text.size() - at < length) return std::nullopt;
  const auto rest = text.substr(at + length);
  auto closing = internal::read_closing(header, rest, at + length);
  if (!closing || *closing == 0 || *closing != rest.size()) return std::nullopt;
  Message message{header, octets.subspan(at, length), nullptr, at};
  const auto address = reinterpret_cast<std::uintptr_t>(message.elements.data());
  if (message.plain() && address % size_of(header.info.scalar) != 0) return std::nullopt;
  return message;
}

}  // namespace

ddsi_sertype* make_type() {
  return make_byte_type<ddsi_sertype>(kTypeName, kTypeOps, kSampleOps).release();
}

Sample make_sample(const ddsi_sertype& type, const Pieces& pieces, const Message& message) {
  auto sample = std::make_unique<MessageSample>(type, SDK_DATA);
  const auto& [head, elements, end] = pieces;
  sample->size = kPrelude + head.size() + elements.size() + end.size();
  const bool is_copied = elements.size() <= kMaxCopied;
  auto& begin = sample->begin;
  begin.reserve(kPrelude + head.size() + (is_copied ? elements.size() + end.size() : 0));
  begin.resize(kPrelude);
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
  sample->write_prelude();
  return Sample(sample.release());
}

bool join(ddsi_serdata& sample, const Pieces& pieces) {
  auto& joined = static_cast<MessageSample&>(sample);
  const auto size = pieces[0].size() + pieces[1].size() + pieces[2].size();
  const bool are_copied = joined.elements.empty() && pieces[1].size() <= kMaxCopied;
  if (!are_copied || joined.size + size > kMaxJoined) return false;
  joined.begin.reserve(kMaxJoined);
  for (const auto piece : pieces)
    joined.begin.insert(joined.begin.end(), piece.begin(), piece.end());
  joined.size = joined.begin.size();
  joined.write_prelude();
  return true;
}

Sample make_end(const ddsi_sertype& type) {
  auto sample = std::make_unique<MessageSample>(type, SDK_DATA);
  sample->size = kPrelude;
  sample->begin.resize(kPrelude);
  sample->write_prelude();
  return Sample(sample.release());
}

std::uint64_t octets_of(const ddsi_serdata& sample) {
  const auto size = own(&sample).size;
  return size > kPrelude ? size - kPrelude : 0;
}

Status read_messages(const ddsi_serdata& data, const Limits& limits, internal::HeaderMemo& memo,
                     const std::function<void(Message, std::uint64_t)>& take) {
  const auto& sample = own(&data);
  auto octets = HC_TRY(sequence_of(sample));
  if (auto alone = view_one(octets, limits, memo)) {
    alone->owner = sample.bytes;
    take(alone->keep(), octets.size());
    return {};
  }
  constexpr std::size_t kMost = 10'000;  // limits the memory used by a sample of small messages
  StreamReader reader(limits);
  Message message;
  std::size_t at = 0, count = 0;
  std::uint64_t taken = 0;
  while (true) {
    auto got = HC_TRY(reader.next(message));
    if (got) {
      if (count++ == kMost)
        return Error{Code::TooLarge,
                     "more than " + std::to_string(kMost) + " messages in a sample"};
      // A small message gets a copy, so that it does not keep the memory of all others.
      if (message.elements.size() <= kMaxCopied) message.owner.reset();
      take(message.keep(), reader.bytes() - std::exchange(taken, reader.bytes()));
    } else if (at < octets.size()) {
      const auto space = reader.space();
      const auto part = octets.subspan(at, std::min(space.size(), octets.size() - at));
      std::ranges::copy(part, space.begin());
      reader.commit(part.size());
      at += part.size();
    } else {
      if (reader.finish()) return {};
      return Error{Code::Truncated, "the sample ends inside a message"};
    }
  }
}

}  // namespace hc::dds
