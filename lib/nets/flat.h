// SPDX-License-Identifier: Apache-2.0
#pragma once
// FlatBuffers' binary format, for reading. Pure. Internal.
// Source: https://flatbuffers.dev/internals
//
// What lies outside of the bytes reads as 0, or as nothing, and is noted: a reader checks
// is_sound() at its end and need not do so at each number.

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>
#include <utility>

namespace hc::nets::flat {

static_assert(std::endian::native == std::endian::little, "numbers are copied bytewise");
static_assert(sizeof(std::size_t) >= 8, "sums of places have no overflow");

/// The bytes of a file.
class Bytes {
 public:
  explicit Bytes(std::span<const std::byte> bytes) : bytes_(bytes) {}

  /// The number at a place.
  template <typename Number>
  Number at(std::size_t place) {
    Number number{};
    if (const auto part = span(place, sizeof number); !part.empty())
      std::memcpy(&number, part.data(), sizeof number);
    return number;
  }
  /// `size` bytes from a place; none unless all are there.
  std::span<const std::byte> span(std::size_t place, std::size_t size) {
    if (place <= bytes_.size() && size <= bytes_.size() - place) return bytes_.subspan(place, size);
    is_sound_ = false;
    return {};
  }
  /// Where an offset leads to that is stored at a place and counts from there.
  std::size_t follow(std::size_t place) { return place + at<std::uint32_t>(place); }

  [[nodiscard]] bool is_sound() const { return is_sound_; }

 private:
  std::span<const std::byte> bytes_;
  bool is_sound_ = true;
};

/// A vector of numbers, or of tables.
class Vector {
 public:
  Vector() = default;
  Vector(Bytes& bytes, std::size_t place)
      : bytes_(&bytes),
        begin_(place + sizeof(std::uint32_t)),
        size_(bytes.at<std::uint32_t>(place)) {}

  [[nodiscard]] std::size_t size() const { return size_; }
  /// All elements, each of `width` bytes.
  [[nodiscard]] std::span<const std::byte> bytes(std::size_t width = 1) const {
    return size_ > 0 ? bytes_->span(begin_, size_ * width) : std::span<const std::byte>();
  }
  [[nodiscard]] std::size_t place(std::size_t index, std::size_t width) const {
    return begin_ + index * width;
  }

 private:
  Bytes* bytes_ = nullptr;
  std::size_t begin_ = 0, size_ = 0;
};

/// A table: fields by their numbers, each of which may be absent.
class Table {
 public:
  Table(Bytes& bytes, std::size_t place) : bytes_(&bytes), place_(place) {
    const auto back = bytes.at<std::int32_t>(place);
    map_ = static_cast<std::size_t>(static_cast<std::int64_t>(place) - back);
    fields_ = bytes.at<std::uint16_t>(map_) / 2;
  }
  /// The table of the whole file.
  static Table root(Bytes& bytes) { return {bytes, bytes.follow(0)}; }

  template <typename Number>
  [[nodiscard]] Number number(std::size_t field, Number absent = {}) const {
    const auto place = place_of(field);
    return place > 0 ? bytes_->at<Number>(place) : absent;
  }
  [[nodiscard]] Vector vector(std::size_t field) const {
    const auto place = place_of(field);
    return place > 0 ? Vector(*bytes_, bytes_->follow(place)) : Vector();
  }
  /// Calls `each(Table)` for a vector of tables, of which there may be at most `most`; false if
  /// there are more.
  template <typename Each>
  bool tables(std::size_t field, std::size_t most, const Each& each) const {
    const Vector all = vector(field);
    if (all.size() > most) return false;
    for (std::size_t i = 0; i < all.size(); ++i)
      each(Table(*bytes_, bytes_->follow(all.place(i, sizeof(std::uint32_t)))));
    return true;
  }
  [[nodiscard]] std::string_view string(std::size_t field) const {
    const auto bytes = vector(field).bytes();
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
  }
  /// A table in a field; an empty one if it is absent.
  [[nodiscard]] Table table(std::size_t field) const {
    const auto place = place_of(field);
    return place > 0 ? Table(*bytes_, bytes_->follow(place)) : Table();
  }

 private:
  Table() = default;
  [[nodiscard]] std::size_t place_of(std::size_t field) const {
    constexpr std::size_t kHead = 2;  // its own sizes, in front of the fields' offsets
    if (kHead + field >= fields_) return 0;
    const auto offset = bytes_->at<std::uint16_t>(map_ + 2 * (kHead + field));
    return offset > 0 ? place_ + offset : 0;
  }

  Bytes* bytes_ = nullptr;
  std::size_t place_ = 0, map_ = 0, fields_ = 0;
};

}  // namespace hc::nets::flat
