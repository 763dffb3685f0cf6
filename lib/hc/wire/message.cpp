// SPDX-License-Identifier: Apache-2.0
#include <hc/wire/message.h>

#include <algorithm>
#include <new>

namespace hc {
namespace {

void check_own(const Header& header) {
  auto valid = check(header, {~std::uint64_t{0}});
  HC_CHECK(valid, valid.error().text());
}

}  // namespace

SharedBytes allocate_bytes(std::size_t size) {
  constexpr std::align_val_t kAlignment{64};
  auto* bytes = static_cast<std::byte*>(::operator new(size == 0 ? 1 : size, kAlignment));
  return {bytes, [](std::byte* freed) { ::operator delete(freed, kAlignment); }};
}

SharedBytes SmallBytes::allocate(std::size_t size) {
  HC_CHECK(size <= kMost, size);
  constexpr std::size_t kAlignment = alignof(std::max_align_t);
  std::size_t rounded = (std::max<std::size_t>(size, 1) + kAlignment - 1) / kAlignment * kAlignment;
  if (kBlock - used_ < rounded) {
    block_ = allocate_bytes(kBlock);
    used_ = 0;
  }
  SharedBytes bytes(block_, block_.get() + used_);
  used_ += rounded;
  return bytes;
}

Message Message::keep() const {
  if (owner != nullptr) return *this;
  SharedBytes bytes = allocate_bytes(elements.size());
  if (!elements.empty()) std::memcpy(bytes.get(), elements.data(), elements.size());
  return {header, {bytes.get(), elements.size()}, bytes, byte};
}

Draft Draft::make(const Info& info, std::int32_t width, std::int32_t height) {
  Header header;
  header.info = info;
  header.width = width;
  header.height = height;
  return make(header);
}

Draft Draft::make(const Header& header) {
  check_own(header);  // before its size is believed
  return make(header, allocate_bytes(header.element_bytes()));
}

Draft Draft::make(const Header& header, SharedBytes bytes) {
  check_own(header);
  Draft draft;
  draft.header = header;
  draft.size_ = header.element_bytes();
  draft.bytes_ = std::move(bytes);
  return draft;
}

Message Draft::finish() && {
  Message message{header, {bytes_.get(), size_}, std::move(bytes_), 0};
  size_ = 0;
  return message;
}

}  // namespace hc
