// SPDX-License-Identifier: Apache-2.0
#pragma once
// ROS 2's serialization, CDR (XCDR1, little-endian), of structs. A struct lists its members in
// order in members(); see messages.h. Pure.

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <vector>

#include <hc/base/check.h>
#include <hc/base/result.h>

namespace hc::ros {

static_assert(std::endian::native == std::endian::little, "numbers are copied bytewise");

/// A view of a sequence of numbers of type T, to avoid copies.
template <typename T>
struct Numbers {
  std::span<const std::byte> bytes;
};

/// A view of a string.
struct Characters {
  std::string_view text;
};

/// A serialized message in pieces, to be written in order. `body` views the data of the message;
/// the others are valid until the next write() or the end of their writer.
struct Pieces {
  std::span<const std::byte> head, body, tail;
  [[nodiscard]] std::size_t size() const { return head.size() + body.size() + tail.size(); }
};

namespace internal {

template <typename T>
concept HasMembers = requires(T& message) {
  std::remove_const_t<T>::members(message);
};

template <typename T>
concept Number = std::is_arithmetic_v<T>;

}  // namespace internal

/// Writes messages; reuses its memory.
class CdrWriter {
 public:
  /// Serializes a message, with its encapsulation header (4 bytes). At most one member may be
  /// Numbers or Characters (checked).
  template <internal::HasMembers T>
  Pieces write(const T& message) {
    buffer_.assign(4, std::byte{0});
    buffer_[1] = std::byte{1};
    body_ = {};
    split_ = kNone;
    put(message);
    const std::span<const std::byte> all(buffer_);
    const std::size_t split = split_ == kNone ? all.size() : split_;
    return {all.first(split), body_, all.subspan(split)};
  }

 private:
  static constexpr std::size_t kNone = ~std::size_t{0};

  void append(const void* bytes, std::size_t size) {
    const auto* begin = static_cast<const std::byte*>(bytes);
    buffer_.insert(buffer_.end(), begin, begin + size);
  }
  void align(std::size_t size) {
    const std::size_t at = buffer_.size() + body_.size() - 4;
    buffer_.resize(buffer_.size() + (size - at % size) % size);
  }
  void put_body(std::span<const std::byte> bytes) {
    HC_CHECK(split_ == kNone);
    split_ = buffer_.size();
    body_ = bytes;
  }

  template <internal::Number T>
  void put(const T& number) {
    align(sizeof(T));
    append(&number, sizeof(T));
  }
  void put_text(std::string_view text) {
    put(static_cast<std::uint32_t>(text.size() + 1));
    append(text.data(), text.size());
    append("", 1);
  }
  void put(const std::string& text) { put_text(text); }
  void put(const Characters& characters) {
    put(static_cast<std::uint32_t>(characters.text.size() + 1));
    put_body(std::as_bytes(std::span(characters.text)));
    append("", 1);
  }
  template <typename T>
  void put(const Numbers<T>& numbers) {
    put(static_cast<std::uint32_t>(numbers.bytes.size() / sizeof(T)));
    if (numbers.bytes.empty()) return;
    align(sizeof(T));
    put_body(numbers.bytes);
  }
  template <typename T, std::size_t kSize>
  void put(const std::array<T, kSize>& list) {
    for (const auto& each : list) put(each);
  }
  template <typename T>
  void put(const std::vector<T>& list) {
    put(static_cast<std::uint32_t>(list.size()));
    for (const auto& each : list) put(each);
  }
  template <internal::HasMembers T>
  void put(const T& message) {
    std::apply([this](const auto&... member) { (this->put(member), ...); }, T::members(message));
  }

  std::vector<std::byte> buffer_;
  std::span<const std::byte> body_;
  std::size_t split_ = kNone;  // position of the body in buffer_
};

/// Reads one message. Memory is at most proportional to the input, even if that is hostile.
class CdrReader {
 public:
  /// @param bytes  a message with its encapsulation header, viewed by Numbers and Characters of the
  ///   result. Bytes behind it are ignored, since middleware pads.
  ///
  /// Errors: Unsupported (not little-endian XCDR1); Malformed (too short; a string without a NUL).
  template <internal::HasMembers T>
  static Result<T> read(std::span<const std::byte> bytes) {
    if (bytes.size() < 4) return Error{Code::Malformed, "CDR: no encapsulation header"};
    if (bytes[0] != std::byte{0} || bytes[1] != std::byte{1})
      return Error{Code::Unsupported, "CDR: not plain little-endian (XCDR1)"};
    CdrReader reader(bytes.subspan(4));
    T message;
    reader.get(message);
    if (reader.wrong_ != nullptr)
      return Error{Code::Malformed, "CDR: " + std::string(reader.wrong_) + " at byte " +
                                        std::to_string(reader.at_ + 4)};
    return message;
  }

 private:
  explicit CdrReader(std::span<const std::byte> bytes) : bytes_(bytes) {}

  /// The next bytes; empty, with an error, if there are fewer.
  std::span<const std::byte> take(std::uint64_t size) {
    if (wrong_ == nullptr && size > bytes_.size() - at_) wrong_ = "the message ends too early";
    if (wrong_ != nullptr) return {};
    at_ += size;
    return bytes_.subspan(at_ - size, size);
  }
  void align(std::size_t size) { static_cast<void>(take((size - at_ % size) % size)); }

  template <internal::Number T>
  void get(T& number) {
    align(sizeof(T));
    if (const auto bytes = take(sizeof(T)); wrong_ == nullptr) {
      if constexpr (std::is_same_v<T, bool>)
        number = bytes[0] != std::byte{0};
      else
        std::memcpy(&number, bytes.data(), sizeof(T));
    }
  }
  std::uint32_t get_length() {
    std::uint32_t length = 0;
    get(length);
    return wrong_ == nullptr ? length : 0;
  }
  void get(Characters& characters) {
    const std::uint32_t length = get_length();
    const auto bytes = take(length);
    if (bytes.empty()) return;  // some writers omit the zero byte of an empty string
    if (bytes.back() != std::byte{0}) wrong_ = "a string has no zero byte at its end";
    characters.text = {reinterpret_cast<const char*>(bytes.data()), bytes.size() - 1};
  }
  void get(std::string& text) {
    Characters characters;
    get(characters);
    text = characters.text;
  }
  template <typename T>
  void get(Numbers<T>& numbers) {
    const std::uint64_t length = get_length();
    if (length == 0) return;
    align(sizeof(T));
    numbers.bytes = take(length * sizeof(T));
  }
  template <typename T, std::size_t kSize>
  void get(std::array<T, kSize>& list) {
    for (auto& each : list) get(each);
  }
  template <typename T>
  void get(std::vector<T>& list) {
    for (std::uint32_t left = get_length(); left > 0 && wrong_ == nullptr; --left) {
      T each{};
      get(each);
      list.push_back(std::move(each));
    }
  }
  template <internal::HasMembers T>
  void get(T& message) {
    std::apply([this](auto&... member) { (this->get(member), ...); }, T::members(message));
  }

  std::span<const std::byte> bytes_;  // after the header, where alignment starts
  std::size_t at_ = 0;
  const char* wrong_ = nullptr;
};

}  // namespace hc::ros
