// SPDX-License-Identifier: Apache-2.0
#pragma once
// The elements of messages and drafts as numbers of a type, without a copy. Header only. Pure.

#include <cstddef>
#include <span>
#include <stdexcept>
#include <string>

#include <hc/base/check.h>
#include <hc/mtp/message.h>

namespace hc {

namespace internal {
[[noreturn]] inline void refuse_index(std::size_t index, std::size_t size) {
  throw std::out_of_range("index " + std::to_string(index) + " of " + std::to_string(size));
}

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

/// The elements of a message; the view lives as long as they do.
///
/// Errors: Unsupported (compressed; another scalar than T).
template <ScalarType T>
Result<MatrixView<const T>> view(const Message& message) {
  const Header& header = message.header;
  if (!message.plain() || header.info.scalar != scalar_for<T>())
    return Error{Code::Unsupported, "the elements are " + matrix_text(header.info) + ", " +
                                        std::string(name(header.info.encoding)) + ", not plain " +
                                        std::string(name(scalar_for<T>()))};
  return MatrixView<const T>(reinterpret_cast<const T*>(message.elements.data()),
                             static_cast<std::size_t>(header.height),
                             static_cast<std::size_t>(header.width), header.info.components);
}

/// The elements of a draft, to be written. Another scalar than the draft's is a bug.
template <ScalarType T>
MatrixView<T> view(const Draft& draft) {
  const Header& header = draft.header;
  HC_CHECK(header.info.scalar == scalar_for<T>(), matrix_text(header.info));
  return {reinterpret_cast<T*>(draft.elements().data()), static_cast<std::size_t>(header.height),
          static_cast<std::size_t>(header.width), header.info.components};
}

}  // namespace hc
