// SPDX-License-Identifier: Apache-2.0
#pragma once
// Kinds: what a port takes or gives, as a C++ type, so that a wrong scalar does not compile; and
// messages of a kind. Pure.
//
//     hc::rotation<double>().of(1, 1).finite()   a kind: one rotation
//     hc::rotation(0.0, tilt, pan).at(time)      a message of it

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

/// A kind of message: matrix type and scalar are fixed at compile time, the rest at run time.
template <MatrixType kMatrix, ScalarType T>
struct Kind {
  using Scalar = T;
  static constexpr MatrixType kType = kMatrix;

  PortType type;

  explicit Kind(int components)
      : type{.info = {kMatrix, static_cast<std::uint8_t>(components), scalar_for<T>(),
                      encoding()}} {}

  /// The same in a coordinate system: hc::Coord, or 1000 · to + from (spec/mtp-1.md, R44).
  [[nodiscard]] Kind in(std::int32_t coord) const {
    Kind kind = *this;
    kind.type.coord = coord;
    return kind;
  }
  /// The same with a fixed shape, so that a handler need not check it; 0: any.
  [[nodiscard]] Kind of(std::int32_t width, std::int32_t height) const {
    Kind kind = *this;
    kind.type.width = width;
    kind.type.height = height;
    return kind;
  }
  /// The same of finite numbers: an input drops messages with NaN or infinity, and counts them.
  /// Cost: a look at every number.
  [[nodiscard]] Kind finite() const requires std::floating_point<T> {
    Kind kind = *this;
    kind.type.finite = true;
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

/// Several kinds that one input takes; its handler finds in the header which it got.
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

// The kinds by name, and messages of them. Units and axes are the coordinate system's.

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
template <std::floating_point T>
PositionKind<T> position(int components = 3) {
  return PositionKind<T>(components);
}

/// Rotations roll, pitch, yaw [rad]; 6 or 9 components carry rates and accelerations too.
template <std::floating_point T>
RotationKind<T> rotation(int components = 3) {
  return RotationKind<T>(components);
}

/// A colour image, (height, width, 3): red, green, blue.
template <ScalarType T>
RgbImageKind<T> rgb_image() {
  return RgbImageKind<T>(3);
}

/// A grey image or a depth map, (height, width, 1).
template <ScalarType T>
IntensityImageKind<T> intensity_image() {
  return IntensityImageKind<T>(1);
}

/// An image of bytes, in colour or grey.
/// @param coord  its coordinate system; 0: any.
inline AnyKind any_image(std::int32_t coord = 0) {
  return any_of(rgb_image<std::uint8_t>().in(coord), intensity_image<std::uint8_t>().in(coord));
}

/// A vector for every place of a grid, (height, width, components).
template <ScalarType T>
VectorFieldKind<T> vector_field(int components) {
  return VectorFieldKind<T>(components);
}

/// UTF-8 text.
inline StringKind string() {
  return StringKind(1);
}

/// A matrix of width columns and height rows on homogeneous coordinates: 4 x 4 a pose.
template <std::floating_point T>
TransformationKind<T> transformation(std::int32_t width = 4, std::int32_t height = 4) {
  return TransformationKind<T>(1).of(width, height);
}

/// Weights of all edges of a graph, (nodes, nodes, components).
template <ScalarType T>
DenseGraphKind<T> dense_graph(int components = 1) {
  return DenseGraphKind<T>(components);
}

/// Edges of a graph, (edges, 1, components): from, to, then weights.
template <ScalarType T>
SparseGraphKind<T> sparse_graph(int components = 3) {
  return SparseGraphKind<T>(components);
}

/// Sample frames, (1, width, channels).
template <ScalarType T>
SoundKind<T> sound(int channels) {
  return SoundKind<T>(channels);
}

/// A grid over a place, (height, width, components): occupancy, cost, place cells.
template <ScalarType T>
MapKind<T> map(int components = 1) {
  return MapKind<T>(components);
}

/// Numbers that are nothing else: counters, scores, bids.
template <ScalarType T>
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
            static_cast<std::size_t>(header.width), static_cast<std::size_t>(header.height),
            header.info.components};
  }
  /// All numbers, row by row.
  [[nodiscard]] std::span<const Scalar> numbers() const { return matrix().numbers(); }

  /// The same message with the time of what it says [ns since the Unix epoch].
  [[nodiscard]] MessageOf at(std::int64_t time) const {
    MessageOf message = *this;
    message.header.time = time;
    return message;
  }
  /// The same message in a coordinate system.
  [[nodiscard]] MessageOf in(std::int32_t coord) const {
    MessageOf message = *this;
    message.header.coord = coord;
    return message;
  }
};

/// An input of any kind gets plain messages.
template <>
struct MessageOf<AnyKind> : Message {};

/// A message of kind K that is being made.
template <typename K>
struct DraftOf : Draft {
  using Scalar = typename K::Scalar;
  [[nodiscard]] MatrixView<Scalar> matrix() const { return view<Scalar>(); }
  [[nodiscard]] std::span<Scalar> numbers() const { return matrix().numbers(); }
};

/// Whether no number is NaN or infinite.
template <std::floating_point T, std::size_t kExtent>
bool finite(std::span<T, kExtent> numbers) {
  return std::all_of(numbers.begin(), numbers.end(), [](T each) { return std::isfinite(each); });
}
/// The same of a message; true where its scalar is an integer or it is compressed.
inline bool finite(const Message& message) {
  if (!message.plain()) return true;
  if (message.header.info.scalar == Scalar::F64) return finite(message.view<double>()->numbers());
  if (message.header.info.scalar == Scalar::F32) return finite(message.view<float>()->numbers());
  return true;
}

/// A message of a kind and its numbers, row by row. Another count than width · height · components
/// is a bug. Cost: an allocation and a copy.
template <MatrixType kMatrix, ScalarType T>
MessageOf<Kind<kMatrix, T>> make_message(const Kind<kMatrix, T>& kind, std::int32_t width,
                                         std::int32_t height, std::span<const T> numbers) {
  Draft draft = Draft::make(kind.type.info, width, height);
  const auto room = draft.view<T>().numbers();
  HC_CHECK(room.size() == numbers.size(), width, height, numbers.size());
  std::copy(numbers.begin(), numbers.end(), room.begin());
  return {std::move(draft).finish()};
}

// What follows is for small messages; large ones are written in place (Output::loan()).

/// One position [the coordinate system's unit].
template <std::floating_point T>
MessageOf<PositionKind<T>> position(T x, T y, T z) {
  const T numbers[] = {x, y, z};
  return make_message(position<T>(), 1, 1, std::span<const T>(numbers));
}

/// One rotation: R = Rz(yaw) Ry(pitch) Rx(roll) [rad].
template <std::floating_point T>
MessageOf<RotationKind<T>> rotation(T roll, T pitch, T yaw) {
  const T numbers[] = {roll, pitch, yaw};
  return make_message(rotation<T>(), 1, 1, std::span<const T>(numbers));
}

/// (height, width, 3): red, green, blue.
template <ScalarType T>
MessageOf<RgbImageKind<T>> rgb_image(std::int32_t width, std::int32_t height,
                                     std::type_identity_t<std::span<const T>> pixels) {
  return make_message(rgb_image<T>(), width, height, pixels);
}

/// (height, width, 1).
template <ScalarType T>
MessageOf<IntensityImageKind<T>> intensity_image(std::int32_t width, std::int32_t height,
                                                 std::type_identity_t<std::span<const T>> pixels) {
  return make_message(intensity_image<T>(), width, height, pixels);
}

/// (height, width, components).
template <ScalarType T>
MessageOf<VectorFieldKind<T>> vector_field(std::int32_t width, std::int32_t height, int components,
                                           std::type_identity_t<std::span<const T>> numbers) {
  return make_message(vector_field<T>(components), width, height, numbers);
}

/// One row of text.
inline MessageOf<StringKind> string(std::string_view characters) {
  return make_message(
      string(), static_cast<std::int32_t>(characters.size()), 1,
      std::span{reinterpret_cast<const std::uint8_t*>(characters.data()), characters.size()});
}

/// A matrix of width columns and height rows, row by row.
template <std::floating_point T>
MessageOf<TransformationKind<T>> transformation(std::int32_t width, std::int32_t height,
                                                std::type_identity_t<std::span<const T>> numbers) {
  return make_message(transformation<T>(width, height), width, height, numbers);
}

/// (nodes, nodes, 1).
template <ScalarType T>
MessageOf<DenseGraphKind<T>> dense_graph(std::int32_t nodes,
                                         std::type_identity_t<std::span<const T>> weights) {
  return make_message(dense_graph<T>(), nodes, nodes, weights);
}

/// Edges from, to, weight, one after the other.
template <ScalarType T>
MessageOf<SparseGraphKind<T>> sparse_graph(std::type_identity_t<std::span<const T>> edges) {
  return make_message(sparse_graph<T>(), 1, static_cast<std::int32_t>(edges.size() / 3), edges);
}

/// Sample frames, the channels of a frame next to one another.
template <ScalarType T>
MessageOf<SoundKind<T>> sound(int channels, std::type_identity_t<std::span<const T>> samples) {
  const auto frames = samples.size() / static_cast<std::size_t>(channels);
  return make_message(sound<T>(channels), static_cast<std::int32_t>(frames), 1, samples);
}

/// (height, width, 1).
template <ScalarType T>
MessageOf<MapKind<T>> map(std::int32_t width, std::int32_t height,
                          std::type_identity_t<std::span<const T>> cells) {
  return make_message(map<T>(), width, height, cells);
}

/// One row of a table with a single component.
template <ScalarType T>
MessageOf<TableKind<T>> table(std::span<const T> numbers) {
  return make_message(table<T>(), static_cast<std::int32_t>(numbers.size()), 1, numbers);
}
template <ScalarType T>
MessageOf<TableKind<T>> table(std::initializer_list<T> numbers) {
  return table<T>(std::span<const T>(numbers.begin(), numbers.size()));
}

}  // namespace hc
