// SPDX-License-Identifier: Apache-2.0
#pragma once
// A message in memory: a header and its elements, viewed and checked without a copy. Pure.
// A Message is a value; copies share the elements, which nobody changes any more.

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
/// Throws std::out_of_range.
[[noreturn]] void refuse_index(std::size_t index, std::size_t size);
}  // namespace internal

/// Numbers next to one another in memory: a std::span whose indices are checked, since how many
/// there are is up to the peer. Iterators and data() are not checked.
///
/// Throws: std::out_of_range; a handler's message is then dropped and counted as bad.
template <typename T>
class Numbers : public std::span<T> {
 public:
  using std::span<T>::span;
  Numbers(std::span<T> numbers) : std::span<T>(numbers) {}  // NOLINT(google-explicit-constructor)

  T& operator[](std::size_t i) const { return this->data()[checked(i, this->size())]; }
  T& front() const { return (*this)[0]; }
  T& back() const { return (*this)[this->size() - 1]; }
  [[nodiscard]] Numbers first(std::size_t count) const { return subspan(0, count); }
  [[nodiscard]] Numbers last(std::size_t count) const { return subspan(this->size() - count, count); }
  [[nodiscard]] Numbers subspan(std::size_t begin, std::size_t count) const {
    return {this->data() + checked(begin, this->size() + 1),
            checked(count, this->size() - begin + 1)};
  }

 private:
  static std::size_t checked(std::size_t index, std::size_t size) {
    if (index >= size) [[unlikely]]
      internal::refuse_index(index, size);
    return index;
  }
};

/// A matrix in memory, row by row without padding: (height, width, components), row 0 on top.
/// `T` is a scalar type, const for a matrix that is only read. Does not own what it shows.
/// An index outside throws as that of Numbers does.
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

  /// The numbers of a row, the components of an element next to one another.
  [[nodiscard]] Numbers<T> row(std::size_t y) const {
    check(y, height_);
    return {data_ + y * width_ * components_, width_ * components_};
  }

  /// One number: component `k` of the element at column `x` of row `y`.
  [[nodiscard]] T& at(std::size_t y, std::size_t x, std::size_t k = 0) const {
    check(y, height_);
    check(x, width_);
    check(k, components_);
    return data_[(y * width_ + x) * components_ + k];
  }

 private:
  static void check(std::size_t index, std::size_t size) {
    if (index >= size) [[unlikely]]
      internal::refuse_index(index, size);
  }

  T* data_ = nullptr;
  std::size_t height_ = 0, width_ = 0, components_ = 0;
};

/// Bytes that several messages and readers share; freed with the last of them.
using SharedBytes = std::shared_ptr<std::byte[]>;

/// Fresh bytes, not initialised, aligned to 64. Cost: one allocation, and no locked instruction
/// until they are shared.
SharedBytes allocate_bytes(std::size_t size);

/// A header and its elements.
struct Message {
  Header header;
  /// In the binary form (R33) and aligned for the scalar, whatever the encoding on the wire was;
  /// but the compressed bytes as they came when the encoding is zstd or jpeg (hc::expand opens
  /// them).
  std::span<const std::byte> elements;
  /// Keeps `elements` alive; null when they are somebody else's (see keep()).
  std::shared_ptr<const void> owner;
  /// Where the elements began in their stream, for error lines. [byte]
  std::uint64_t byte = 0;

  /// Elements that are not compressed.
  [[nodiscard]] bool plain() const {
    return header.info.encoding == Encoding::Text || header.info.encoding == Encoding::Binary;
  }

  /// The elements as numbers of type T, without a copy; lives as long as the elements.
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

  /// The bytes of a string, all rows one after the other.
  [[nodiscard]] std::string_view text() const {
    return {reinterpret_cast<const char*>(elements.data()), elements.size()};
  }

  /// This message, safe to hold: itself when it has an owner, else with a copy of the elements.
  [[nodiscard]] Message keep() const;
};

/// A message that is being made: its elements can be written until it is finished.
///
///     auto draft = Draft::make(rgb, 600, 800);
///     fill(draft.view<std::uint8_t>());
///     output.send(std::move(draft).finish());
class Draft {
 public:
  Draft() = default;
  /// Room for height × width elements, not initialised, with a header that says so.
  /// A header that check() refuses is a bug. Cost: one allocation.
  static Draft make(const Info& info, std::int32_t height, std::int32_t width);
  /// The same with the rest of the header given too.
  static Draft make(const Header& header);
  /// The same in memory that is there already, aligned for the scalar and as large as is needed.
  static Draft make(const Header& header, SharedBytes bytes);

  Header header;  ///< everything but info, width and height may be changed

  [[nodiscard]] std::span<std::byte> elements() const { return {bytes_.get(), size_}; }

  /// The elements as numbers of type T. Another scalar than the info's is a bug.
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
