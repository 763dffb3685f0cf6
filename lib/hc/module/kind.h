// SPDX-License-Identifier: Apache-2.0
#pragma once
// Kinds: what a port takes or gives, as a C++ type, so that a wrong scalar does not compile; and
// messages of a kind. Shapes are (height, width), as in NumPy. Pure.
//
//     hc::rotation().of(1, 1).in(hc::Coord::kGaze).finite()   a kind: one rotation, the gaze
//     hc::table().message({1, 2, 3})                          a message of a kind

#include <algorithm>
#include <cmath>
#include <concepts>
#include <initializer_list>
#include <span>
#include <string_view>
#include <type_traits>
#include <vector>

#include <hc/contract/port_type.h>
#include <hc/mtp/coords.h>
#include <hc/mtp/message.h>

namespace hc {

template <typename K>
struct MessageOf;

/// A kind of message: matrix type and scalar are fixed at compile time, the rest at run time.
template <MatrixType kMatrix, ScalarType T>
struct Kind {
  using Scalar = T;
  static constexpr MatrixType kType = kMatrix;

  PortType type;

  explicit Kind(int components)
      : type{.info = {kMatrix, static_cast<std::uint8_t>(components), scalar_for<T>(),
                      encoding()}} {}
  /// Of a port's type, which has this matrix type and scalar.
  explicit Kind(const PortType& declared) : type(declared) {}

  /// The same in a coordinate system: hc::Coord, or 1000 · to + from (spec/mtp-1.md, R44).
  [[nodiscard]] Kind in(std::int32_t coord) const {
    Kind kind = *this;
    kind.type.coord = coord;
    return kind;
  }
  /// The same with a fixed shape, so that a handler need not check it; 0: any.
  [[nodiscard]] Kind of(std::int32_t height, std::int32_t width) const {
    Kind kind = *this;
    kind.type.height = height;
    kind.type.width = width;
    return kind;
  }
  /// The same of finite numbers: an input drops messages with NaN or infinity, and counts them.
  /// Cost: a look at every number.
  [[nodiscard]] Kind finite() const requires std::floating_point<T> {
    Kind kind = *this;
    kind.type.finite = true;
    return kind;
  }

  /// A message of this kind and its numbers, row by row. Another count than height · width ·
  /// components is a bug. Cost: an allocation and a copy.
  [[nodiscard]] MessageOf<Kind> message(std::int32_t height, std::int32_t width,
                                        std::span<const T> numbers) const;
  /// The same with the shape that the kind and the count give: the sides that of() has fixed, else
  /// one row; of a dense graph a square, of a sparse one a column of edges.
  [[nodiscard]] MessageOf<Kind> message(std::span<const T> numbers) const;
  [[nodiscard]] MessageOf<Kind> message(std::initializer_list<T> numbers) const;
  /// One row of text.
  [[nodiscard]] MessageOf<Kind> message(std::string_view text) const
      requires(kMatrix == MatrixType::String);

  /// Small things are written as text, to be read by eye; large ones in binary.
  static constexpr Encoding encoding() {
    bool small = kMatrix == MatrixType::Position || kMatrix == MatrixType::Rotation ||
                 kMatrix == MatrixType::String || kMatrix == MatrixType::Transformation ||
                 kMatrix == MatrixType::Table;
    return small ? Encoding::Text : Encoding::Binary;
  }
};

/// Several kinds that one input takes; its handler finds in the header which it got.
struct AnyKind {
  std::vector<PortType> types;
};

/// An image of bytes, in colour or grey: its messages are hc::Image.
struct ImageKind : AnyKind {};

template <typename... Kinds>
AnyKind any_of(const Kinds&... kinds) {
  return {{kinds.type...}};
}

/// Every kind of message.
inline AnyKind anything() {
  return {};
}

// The kinds by name. Units and axes are the coordinate system's.

template <ScalarType T>
using PositionKind = Kind<MatrixType::Position, T>;
template <ScalarType T>
using RotationKind = Kind<MatrixType::Rotation, T>;
template <ScalarType T>
using RgbImageKind = Kind<MatrixType::RgbImage, T>;
template <ScalarType T>
using IntensityImageKind = Kind<MatrixType::IntensityImage, T>;
template <ScalarType T>
using VectorFieldKind = Kind<MatrixType::VectorField, T>;
using StringKind = Kind<MatrixType::String, std::uint8_t>;
template <ScalarType T>
using TransformationKind = Kind<MatrixType::Transformation, T>;
template <ScalarType T>
using DenseGraphKind = Kind<MatrixType::DenseGraph, T>;
template <ScalarType T>
using SparseGraphKind = Kind<MatrixType::SparseGraph, T>;
template <ScalarType T>
using SoundKind = Kind<MatrixType::Sound, T>;
template <ScalarType T>
using MapKind = Kind<MatrixType::Map, T>;
template <ScalarType T>
using TableKind = Kind<MatrixType::Table, T>;

/// Positions x y z; 6 or 9 components carry velocity and acceleration too.
template <std::floating_point T = double>
PositionKind<T> position(int components = 3) {
  return PositionKind<T>(components);
}

/// Rotations roll, pitch, yaw [rad], R = Rz(yaw) Ry(pitch) Rx(roll); 6 or 9 components carry rates
/// and accelerations too.
template <std::floating_point T = double>
RotationKind<T> rotation(int components = 3) {
  return RotationKind<T>(components);
}

/// A colour image, (height, width, 3): red, green, blue.
template <ScalarType T = std::uint8_t>
RgbImageKind<T> rgb_image() {
  return RgbImageKind<T>(3);
}

/// A grey image or a depth map, (height, width, 1).
template <ScalarType T = std::uint8_t>
IntensityImageKind<T> intensity_image() {
  return IntensityImageKind<T>(1);
}

/// An image of bytes, in colour or grey, for an input.
/// @param coord  its coordinate system; 0: any.
inline ImageKind image(std::int32_t coord = 0) {
  return {any_of(rgb_image().in(coord), intensity_image().in(coord))};
}

/// A vector for every place of a grid, (height, width, components).
template <ScalarType T = float>
VectorFieldKind<T> vector_field(int components) {
  return VectorFieldKind<T>(components);
}

/// UTF-8 text.
inline StringKind string() {
  return StringKind(1);
}

/// A matrix on homogeneous coordinates: (4, 4) a pose.
template <std::floating_point T = double>
TransformationKind<T> transformation(std::int32_t height = 4, std::int32_t width = 4) {
  return TransformationKind<T>(1).of(height, width);
}

/// Weights of all edges of a graph, (nodes, nodes, components).
template <ScalarType T = double>
DenseGraphKind<T> dense_graph(int components = 1) {
  return DenseGraphKind<T>(components);
}

/// Edges of a graph, (edges, 1, components): from, to, then weights.
template <ScalarType T = double>
SparseGraphKind<T> sparse_graph(int components = 3) {
  return SparseGraphKind<T>(components);
}

/// Sample frames, (1, frames, channels).
template <ScalarType T = std::int16_t>
SoundKind<T> sound(int channels) {
  return SoundKind<T>(channels);
}

/// A grid over a place, (height, width, components): occupancy, cost, place cells.
template <ScalarType T = double>
MapKind<T> map(int components = 1) {
  return MapKind<T>(components);
}

/// Numbers that are nothing else: counters, scores, bids.
template <ScalarType T = double>
TableKind<T> table(int components = 1) {
  return TableKind<T>(components);
}

/// A message that is known to be of kind K.
template <typename K>
struct MessageOf : Message {
  using Scalar = typename K::Scalar;

  /// The elements: (height, width, components).
  [[nodiscard]] MatrixView<const Scalar> matrix() const {
    return {reinterpret_cast<const Scalar*>(elements.data()),
            static_cast<std::size_t>(header.height), static_cast<std::size_t>(header.width),
            header.info.components};
  }
  /// All numbers, row by row.
  [[nodiscard]] Numbers<const Scalar> numbers() const { return matrix().numbers(); }
};

/// An input of any kind gets plain messages.
template <>
struct MessageOf<AnyKind> : Message {};

/// An image of bytes, in colour or grey.
template <>
struct MessageOf<ImageKind> : Message {
  /// (height, width, 3) red, green, blue; or (height, width, 1).
  [[nodiscard]] MatrixView<const std::uint8_t> matrix() const {
    return {reinterpret_cast<const std::uint8_t*>(elements.data()),
            static_cast<std::size_t>(header.height), static_cast<std::size_t>(header.width),
            header.info.components};
  }
  /// All numbers, row by row, 0 … 255.
  [[nodiscard]] Numbers<const std::uint8_t> pixels() const { return matrix().numbers(); }
  [[nodiscard]] bool is_colour() const { return header.info.components == 3; }
};
using Image = MessageOf<ImageKind>;

/// A message of kind K that is being made.
template <typename K>
struct DraftOf : Draft {
  using Scalar = typename K::Scalar;
  [[nodiscard]] MatrixView<Scalar> matrix() const { return view<Scalar>(); }
  [[nodiscard]] Numbers<Scalar> numbers() const { return matrix().numbers(); }
};

/// Whether no number is NaN or infinite.
template <std::floating_point T, std::size_t kExtent>
bool finite(std::span<T, kExtent> numbers) {
  return std::all_of(numbers.begin(), numbers.end(), [](T each) { return std::isfinite(each); });
}
/// The same of a message; true where its scalar is an integer or it is compressed.
inline bool finite(const Message& message) {
  if (!message.plain()) return true;
  auto is_finite = [](auto view) { return finite(std::span(view->numbers())); };
  if (message.header.info.scalar == Scalar::F64) return is_finite(message.view<double>());
  if (message.header.info.scalar == Scalar::F32) return is_finite(message.view<float>());
  return true;
}

template <MatrixType kMatrix, ScalarType T>
MessageOf<Kind<kMatrix, T>> Kind<kMatrix, T>::message(std::int32_t height, std::int32_t width,
                                                      std::span<const T> numbers) const {
  Draft draft = Draft::make(type.info, height, width);
  draft.header.coord = type.coord;
  const auto room = draft.view<T>().numbers();
  HC_CHECK(room.size() == numbers.size(), height, width, numbers.size());
  std::copy(numbers.begin(), numbers.end(), room.begin());
  return {std::move(draft).finish()};
}

template <MatrixType kMatrix, ScalarType T>
MessageOf<Kind<kMatrix, T>> Kind<kMatrix, T>::message(std::span<const T> numbers) const {
  const auto shape = shape_of(type, numbers.size());
  HC_CHECK(shape, numbers.size(), in_words(type));
  return message(shape->first, shape->second, numbers);
}

template <MatrixType kMatrix, ScalarType T>
MessageOf<Kind<kMatrix, T>> Kind<kMatrix, T>::message(std::initializer_list<T> numbers) const {
  return message(std::span<const T>(numbers.begin(), numbers.size()));
}

template <MatrixType kMatrix, ScalarType T>
MessageOf<Kind<kMatrix, T>> Kind<kMatrix, T>::message(std::string_view text) const
    requires(kMatrix == MatrixType::String) {
  return message(std::span(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
}

}  // namespace hc
