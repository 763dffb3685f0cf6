// SPDX-License-Identifier: Apache-2.0
#pragma once
// The element type of a message: matrix type, components, scalar and encoding, and the header field
// `info` with its six decimal digits (spec/mtp-1.md, section 3). Pure.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>

#include <hc/base/result.h>

namespace hc {

/// The meaning of a matrix; TT of the info field.
enum class MatrixType : std::uint8_t {
  Position = 1,
  Rotation,
  RgbImage,
  IntensityImage,
  VectorField,
  String,
  Transformation,
  DenseGraph,
  SparseGraph,
  Sound,
  Map,
  Table,
};

/// The type of a number; S of the info field.
enum class Scalar : std::uint8_t { U8, I8, U16, I16, U32, I32, U64, I64, F32, F64 };

/// The encoding of the elements on the wire; E of the info field.
enum class Encoding : std::uint8_t { Text, Binary, Zstd, Jpeg };

/// Name in the specification, such as "rgb_image", "f64", "zstd".
std::string_view name(MatrixType type);
std::string_view name(Scalar scalar);
std::string_view name(Encoding encoding);

/// The inverses; nullopt if there is no such name.
std::optional<MatrixType> matrix_type_of(std::string_view name);
std::optional<Scalar> scalar_of(std::string_view name);
std::optional<Encoding> encoding_of(std::string_view name);

/// Size of a scalar: 1, 2, 4 or 8 [byte].
constexpr std::size_t size_of(Scalar scalar) {
  constexpr std::uint8_t kSizes[] = {1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
  return kSizes[static_cast<std::size_t>(scalar)];
}

/// The C++ types that correspond to a scalar.
template <typename T>
concept ScalarType =
    (std::is_integral_v<T> && !std::is_same_v<std::remove_cv_t<T>, bool>) ||
    std::is_same_v<std::remove_cv_t<T>, float> || std::is_same_v<std::remove_cv_t<T>, double>;

/// The scalar of a C++ type: scalar_for<float>() is Scalar::F32.
template <ScalarType T>
constexpr Scalar scalar_for() {
  if constexpr (std::is_floating_point_v<T>) {
    return sizeof(T) == 4 ? Scalar::F32 : Scalar::F64;
  } else {
    constexpr int kLog = sizeof(T) == 1 ? 0 : sizeof(T) == 2 ? 1 : sizeof(T) == 4 ? 2 : 3;
    return static_cast<Scalar>(2 * kLog + (std::is_signed_v<T> ? 1 : 0));
  }
}

/// Calls `f` with a zero of the C++ type of `scalar`.
///
///     visit_scalar(info.scalar, [&](auto zero) { using T = decltype(zero); … });
template <typename F>
decltype(auto) visit_scalar(Scalar scalar, F&& f) {
  using Zero = std::variant<std::uint8_t, std::int8_t, std::uint16_t, std::int16_t, std::uint32_t,
                            std::int32_t, std::uint64_t, std::int64_t, float, double>;
  static constexpr std::array<Zero, 10> kZeros = {
      std::uint8_t{}, std::int8_t{},   std::uint16_t{}, std::int16_t{}, std::uint32_t{},
      std::int32_t{}, std::uint64_t{}, std::int64_t{},  float{},        double{}};
  return std::visit(std::forward<F>(f), kZeros[static_cast<std::size_t>(scalar)]);
}

/// The type and encoding of the elements.
struct Info {
  MatrixType type = MatrixType::Position;
  std::uint8_t components = 3;  ///< numbers per element, 1 … 99
  Scalar scalar = Scalar::F64;
  Encoding encoding = Encoding::Text;

  /// The header's `info`, TTCCSE: 10390 for a position of three f64 in text.
  [[nodiscard]] constexpr std::int32_t code() const {
    return static_cast<std::int32_t>(type) * 10000 + components * 100 +
           static_cast<std::int32_t>(scalar) * 10 + static_cast<std::int32_t>(encoding);
  }

  /// Size of an element in binary form.
  [[nodiscard]] constexpr std::size_t element_bytes() const { return components * size_of(scalar); }

  bool operator==(const Info&) const = default;
};

/// A readable description, "rgb_image 800 x 600 of 3 x u8"; a side not given is "any", as in
/// "position any x 1 of 3 x f64"; without both, "rgb_image of 3 x u8".
std::string matrix_text(const Info& info, std::optional<std::int32_t> width = std::nullopt,
                        std::optional<std::int32_t> height = std::nullopt);

/// The first rule that the combination of type, components, scalar and encoding breaks (R17 … R21);
/// 0: none.
int broken_rule(const Info& info);

/// The rule that an info breaks, and how.
struct InfoError {
  int rule = 0;  ///< 17 … 21
  std::string what;

  [[nodiscard]] Code code() const { return rule == 20 ? Code::Unsupported : Code::Malformed; }
};

/// The error that broken_rule() finds, in words, if any.
std::optional<InfoError> find_error(const Info& info);

/// Parses the header's `info`, `code` ≥ 0; returns the error if it is invalid.
std::optional<InfoError> parse_info(std::int64_t code, Info& info);

}  // namespace hc
