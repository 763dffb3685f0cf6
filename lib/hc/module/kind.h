// SPDX-License-Identifier: Apache-2.0
#pragma once
// Kinds: what a port takes or gives, as a C++ type, so that a wrong scalar does not compile; and
// messages of a kind. Pure.

#include <algorithm>
#include <concepts>
#include <cstring>
#include <initializer_list>
#include <string_view>
#include <vector>

#include <hc/mtp/message.h>

namespace hc {

/// What a port takes: elements, and shape and coordinate system where they are fixed.
struct PortType {
  Info info;                ///< the encoding is the one that an output writes unless told otherwise
  std::int32_t width = 0;   ///< 0: any
  std::int32_t height = 0;  ///< 0: any
  std::int32_t coord = 0;   ///< 0: any
};

/// Whether a message fits a type.
///
/// Errors: Malformed; the detail begins with the rule of the field that does not fit, "R19: …".
Status fits(const Header& header, const PortType& type);

/// "rgb_image 3 x u8, coordinate system 9"; several with "or" between them, none: "anything".
std::string in_words(const PortType& type);
std::string in_words(const std::vector<PortType>& types);

/// A kind of message: matrix type and scalar are fixed at compile time, the rest when it is made.
template <MatrixType kMatrix, ScalarType T>
struct Kind {
  using Scalar = T;
  static constexpr MatrixType kType = kMatrix;

  PortType type;

  explicit Kind(int components, std::int32_t width = 0, std::int32_t height = 0)
      : type{{kMatrix, static_cast<std::uint8_t>(components), scalar_for<T>(), encoding()},
             width,
             height} {}

  /// The same in a coordinate system (spec/mtp-1.md, R44).
  [[nodiscard]] Kind in(std::int32_t coord) const {
    Kind kind = *this;
    kind.type.coord = coord;
    return kind;
  }

  /// Small things are written as text, to be read by eye; large ones in binary.
  static constexpr Encoding encoding() {
    bool small = kMatrix == MatrixType::Position || kMatrix == MatrixType::Rotation ||
                 kMatrix == MatrixType::String || kMatrix == MatrixType::Transformation ||
                 kMatrix == MatrixType::Table;
    return small ? Encoding::Text : Encoding::Binary;
  }
};

/// Several kinds that one input takes; its handler looks at the header to see which has come.
struct AnyKind {
  std::vector<PortType> types;
};

template <typename... Kinds>
AnyKind any_of(const Kinds&... kinds) {
  return {{kinds.type...}};
}

/// Every kind of message.
inline AnyKind anything() {
  return {};
}

// The kinds by name. Shapes, frames and units are the coordinate system's.

template <ScalarType T>
using PositionKind = Kind<MatrixType::Position, T>;
/// One position, x y z; 6 or 9 components carry velocity and acceleration too.
template <std::floating_point T>
PositionKind<T> position(int components = 3) {
  return PositionKind<T>(components);
}

/// roll, pitch, yaw [rad]; 6 or 9 components carry rates and accelerations too.
template <std::floating_point T>
Kind<MatrixType::Rotation, T> rotation(int components = 3) {
  return Kind<MatrixType::Rotation, T>(components);
}

/// A colour picture, (height, width, 3): red, green, blue.
template <ScalarType T>
Kind<MatrixType::RgbImage, T> rgb_image() {
  return Kind<MatrixType::RgbImage, T>(3);
}

/// A grey picture or a depth map, (height, width, 1).
template <ScalarType T>
Kind<MatrixType::IntensityImage, T> intensity_image() {
  return Kind<MatrixType::IntensityImage, T>(1);
}

/// A vector for every place of a grid, (height, width, components).
template <ScalarType T>
Kind<MatrixType::VectorField, T> vector_field(int components) {
  return Kind<MatrixType::VectorField, T>(components);
}

/// UTF-8 text.
inline Kind<MatrixType::String, std::uint8_t> string() {
  return Kind<MatrixType::String, std::uint8_t>(1);
}

/// A matrix of width columns and height rows on homogeneous coordinates.
template <std::floating_point T>
Kind<MatrixType::Transformation, T> transformation(std::int32_t width, std::int32_t height) {
  return Kind<MatrixType::Transformation, T>(1, width, height);
}

/// Sample frames, (1, width, channels).
template <ScalarType T>
Kind<MatrixType::Sound, T> sound(int channels) {
  return Kind<MatrixType::Sound, T>(channels);
}

/// Numbers that are nothing else: counters, scores, bids.
template <ScalarType T>
Kind<MatrixType::Table, T> table(int components = 1) {
  return Kind<MatrixType::Table, T>(components);
}

/// A message that is known to be of kind K.
template <typename K>
struct MessageOf : Message {
  /// The elements: (height, width, components).
  [[nodiscard]] MatrixView<const typename K::Scalar> matrix() const {
    return {reinterpret_cast<const typename K::Scalar*>(elements.data()),
            static_cast<std::size_t>(header.width), static_cast<std::size_t>(header.height),
            header.info.components};
  }
};

/// What takes any kind sees plain messages.
template <>
struct MessageOf<AnyKind> : Message {};

/// A message of kind K that is being made.
template <typename K>
struct DraftOf : Draft {
  [[nodiscard]] MatrixView<typename K::Scalar> matrix() const { return view<typename K::Scalar>(); }
};

/// One position [the coordinate system's unit].
template <std::floating_point T>
MessageOf<PositionKind<T>> position(T x, T y, T z) {
  Draft draft = Draft::make(position<T>().type.info, 1, 1);
  auto numbers = draft.view<T>().numbers();
  numbers[0] = x;
  numbers[1] = y;
  numbers[2] = z;
  return {std::move(draft).finish()};
}

/// One row of text.
inline MessageOf<Kind<MatrixType::String, std::uint8_t>> string(std::string_view characters) {
  Draft draft = Draft::make(string().type.info, static_cast<std::int32_t>(characters.size()), 1);
  std::memcpy(draft.elements().data(), characters.data(), characters.size());
  return {std::move(draft).finish()};
}

/// One row of a table with a single component.
template <ScalarType T>
MessageOf<Kind<MatrixType::Table, T>> table(std::initializer_list<T> numbers) {
  Draft draft = Draft::make(table<T>().type.info, static_cast<std::int32_t>(numbers.size()), 1);
  std::copy(numbers.begin(), numbers.end(), draft.view<T>().numbers().begin());
  return {std::move(draft).finish()};
}

}  // namespace hc
