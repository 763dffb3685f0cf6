// SPDX-License-Identifier: Apache-2.0
#include <hc/mtp/message.h>

#include <cstdint>
#include <stdexcept>

namespace hc {
namespace {

void check_own(const Header& header) {
  auto valid = check(header, {~std::uint64_t{0}});
  HC_CHECK(valid, valid.error().text());
}

}  // namespace

void internal::refuse_index(std::size_t index, std::size_t size) {
  throw std::out_of_range("index " + std::to_string(index) + " of " + std::to_string(size));
}

SharedBytes allocate_bytes(std::size_t size) {
  constexpr std::size_t kLarge = std::size_t{64} << 10, kPage = 4096, kAlignment = 64;
  // Streams often receive a message at the start of a page in the kernel, with the elements after
  // the header line. Processors with "fast short rep mov" copy some 15 times slower if the target's
  // offset in its page is 1 to 15 bytes after the source's. Large elements therefore start at an
  // offset that no header line ends at, for both directions.
  constexpr std::size_t kOffset = 512;
  static_assert(kOffset >= kMaxHeaderBytes + 16 && kOffset % kAlignment == 0);
  const bool is_large = size >= kLarge;
  const std::size_t period = is_large ? kPage : kAlignment, offset = is_large ? kOffset : 0;
  // The reference count and the bytes are allocated together, with space for alignment.
  auto room = std::make_shared_for_overwrite<std::byte[]>(size + period);
  auto past = reinterpret_cast<std::uintptr_t>(room.get()) % period;
  std::byte* begin = room.get() + (period + offset - past) % period;
  return {std::move(room), begin};
}

Message Message::keep() const {
  if (owner != nullptr) return *this;
  SharedBytes bytes = allocate_bytes(elements.size());
  if (!elements.empty()) std::memcpy(bytes.get(), elements.data(), elements.size());
  return {header, {bytes.get(), elements.size()}, bytes, byte};
}

Draft Draft::make(const Info& info, std::int32_t height, std::int32_t width) {
  Header header;
  header.info = info;
  header.width = width;
  header.height = height;
  return make(header);
}

Draft Draft::make(const Header& header) {
  check_own(header);  // before its size is used
  return {header, allocate_bytes(header.element_bytes())};
}

Draft Draft::make(const Header& header, SharedBytes bytes) {
  check_own(header);
  return {header, std::move(bytes)};
}

Message Draft::finish() && {
  Message message{header, {bytes_.get(), size_}, std::move(bytes_), 0};
  size_ = 0;
  return message;
}

}  // namespace hc
