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

namespace internal {
[[noreturn]] void refuse_index(std::size_t index, std::size_t size);

/// The index; one outside throws std::out_of_range.
inline std::size_t checked(std::size_t index, std::size_t size) {
  if (index >= size) [[unlikely]]
    refuse_index(index, size);
  return index;
}
}  // namespace internal

/// A std::span with checked indices, since the peer decides how many numbers a message has.
/// Iterators and data() are not checked.
///
/// Throws: std::out_of_range; the message being handled is then dropped, and counted as bad.
template <typename T>
class Numbers : public std::span<T> {
 public:
  using std::span<T>::span;
  Numbers(std::span<T> numbers) : std::span<T>(numbers) {}  // NOLINT(google-explicit-constructor)

  T& operator[](std::size_t i) const { return this->data()[internal::checked(i, this->size())]; }
  T& front() const { return (*this)[0]; }
  T& back() const { return (*this)[this->size() - 1]; }
  [[nodiscard]] Numbers first(std::size_t count) const {
    return {this->data(), internal::checked(count, this->size() + 1)};
  }
  [[nodiscard]] Numbers subspan(std::size_t begin) const {
    return {this->data() + internal::checked(begin, this->size() + 1), this->size() - begin};
  }
  Numbers last(std::size_t) const = delete;  // subspan() is checked
};

/// A view of a matrix, row by row without padding: (height, width, components), row 0 on top.
/// `T` is a scalar type, const for a read-only matrix. Does not own the memory.
///
/// Throws: std::out_of_range, as Numbers.
template <typename T>
class MatrixView {
 public:
  MatrixView() = default;
  MatrixView(T* data, std::size_t height, std::size_t width, std::size_t components)
      : data_(data), height_(height), width_(width), components_(components) {}

  [[nodiscard]] std::size_t height() const { return height_; }
  [[nodiscard]] std::size_t width() const { return width_; }
  [[nodiscard]] std::size_t components() const { return components_; }
  [[nodiscard]] bool empty() const { return width_ == 0 || height_ == 0; }

  /// All numbers, row by row.
  [[nodiscard]] Numbers<T> numbers() const { return {data_, height_ * width_ * components_}; }

  /// The numbers of a row; the components of an element are adjacent.
  [[nodiscard]] Numbers<T> row(std::size_t y) const {
    return {data_ + internal::checked(y, height_) * width_ * components_, width_ * components_};
  }

  /// Component `k` of the element at column `x` of row `y`.
  [[nodiscard]] T& at(std::size_t y, std::size_t x, std::size_t k = 0) const {
    using internal::checked;
    return data_[(checked(y, height_) * width_ + checked(x, width_)) * components_ +
                 checked(k, components_)];
  }

 private:
  T* data_ = nullptr;
  std::size_t height_ = 0, width_ = 0, components_ = 0;
};

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

  /// The elements as numbers of type T, without a copy; valid as long as the elements.
  ///
  /// Errors: Unsupported (compressed; another scalar than T).
  template <ScalarType T>
  [[nodiscard]] Result<MatrixView<const T>> view() const {
    if (!plain() || header.info.scalar != scalar_for<T>())
      return Error{Code::Unsupported, "the elements are " + matrix_text(header.info) + ", " +
                                          std::string(name(header.info.encoding)) + ", not plain " +
                                          std::string(name(scalar_for<T>()))};
    return MatrixView<const T>(reinterpret_cast<const T*>(elements.data()),
                               static_cast<std::size_t>(header.height),
                               static_cast<std::size_t>(header.width), header.info.components);
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
///     fill(draft.view<std::uint8_t>());
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

  /// The elements as numbers of type T. A scalar other than the info's is a bug.
  template <ScalarType T>
  [[nodiscard]] MatrixView<T> view() const {
    HC_CHECK(header.info.scalar == scalar_for<T>(), matrix_text(header.info));
    return {reinterpret_cast<T*>(bytes_.get()), static_cast<std::size_t>(header.height),
            static_cast<std::size_t>(header.width), header.info.components};
  }

  /// The message; the draft is empty afterwards.
  [[nodiscard]] Message finish() &&;

 private:
  Draft(const Header& all, SharedBytes bytes)
      : header(all), bytes_(std::move(bytes)), size_(all.element_bytes()) {}

  SharedBytes bytes_;
  std::size_t size_ = 0;
};

}  // namespace hc
