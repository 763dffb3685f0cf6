// SPDX-License-Identifier: Apache-2.0
#pragma once
// Messages in memory: a header and elements that are viewed without a copy. Pure.
// A Message is a value; copies share the elements, which are immutable.

#include <cstddef>
#include <cstring>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include <hc/base/check.h>
#include <hc/base/result.h>
#include <hc/mtp/header.h>

namespace hc {

using SharedBytes = std::shared_ptr<std::byte[]>;

/// Uninitialised bytes, aligned to 64. Cost: one allocation; no atomic operation until they are
/// shared.
SharedBytes allocate_bytes(std::size_t size);

struct Message {
  Header header;
  /// In binary form (R33), aligned for the scalar, for both plain encodings; for zstd and jpeg, the
  /// compressed bytes (see hc::expand).
  std::span<const std::byte> elements;
  /// Keeps `elements` alive; null if another object owns them (see keep()).
  std::shared_ptr<const void> owner;
  /// Offset of the elements in their stream, for errors. [byte]
  std::uint64_t byte = 0;

  /// Whether the elements are uncompressed.
  [[nodiscard]] bool plain() const {
    return header.info.encoding == Encoding::Text || header.info.encoding == Encoding::Binary;
  }

  /// The bytes of a string, all rows concatenated.
  [[nodiscard]] std::string_view text() const {
    return {reinterpret_cast<const char*>(elements.data()), elements.size()};
  }

  /// A message that may be stored: itself if it has an owner, else a copy.
  [[nodiscard]] Message keep() const;
};

/// A message under construction: its elements are writable until finish().
///
///     auto draft = Draft::make(rgb, 600, 800);
///     fill(view<std::uint8_t>(draft));
///     output.send(std::move(draft).finish());
class Draft {
 public:
  Draft() = default;
  /// Allocates height × width elements, uninitialised, and sets the header accordingly.
  /// A header that check() refuses is a bug. Cost: one allocation.
  static Draft make(const Info& info, std::int32_t height, std::int32_t width);
  /// With a complete header.
  static Draft make(const Header& header);
  /// In existing memory, aligned for the scalar and large enough.
  static Draft make(const Header& header, SharedBytes bytes);

  Header header;  ///< all fields may be changed except info, width and height

  [[nodiscard]] std::span<std::byte> elements() const { return {bytes_.get(), size_}; }

  /// The message; the draft is empty afterwards.
  [[nodiscard]] Message finish() &&;

 private:
  Draft(const Header& all, SharedBytes bytes)
      : header(all), bytes_(std::move(bytes)), size_(all.element_bytes()) {}

  SharedBytes bytes_;
  std::size_t size_ = 0;
};

}  // namespace hc
