// SPDX-License-Identifier: Apache-2.0
#include <hc/mtp/element.h>

#include <algorithm>
#include <array>

#include <hc/base/text.h>

namespace hc {
namespace {

constexpr std::uint16_t kAllScalars = 0x3ff;
constexpr std::uint16_t kFloats = 0x300;
constexpr std::uint16_t kU8 = 0x001;
constexpr std::uint16_t kU8U16Floats = 0x305;

/// A row of the specification's registry of matrix types.
struct TypeRule {
  std::string_view name;
  std::uint16_t scalars;     ///< bit S: the type may have scalar S
  std::uint8_t least, most;  ///< components
  bool by_threes;            ///< components must be a multiple of 3
  std::string_view components_in_words;
};

constexpr std::array<TypeRule, 12> kTypes = {{
    {"position", kFloats, 3, 9, true, "3, 6 or 9"},
    {"rotation", kFloats, 3, 9, true, "3, 6 or 9"},
    {"rgb_image", kU8U16Floats, 3, 4, false, "3 or 4"},
    {"intensity_image", kAllScalars, 1, 1, false, "1"},
    {"vector_field", kAllScalars, 1, 99, false, "1 to 99"},
    {"string", kU8, 1, 1, false, "1"},
    {"transformation", kFloats, 1, 1, false, "1"},
    {"dense_graph", kAllScalars, 1, 99, false, "1 to 99"},
    {"sparse_graph", kAllScalars, 2, 99, false, "2 to 99"},
    {"sound", kAllScalars, 1, 99, false, "1 to 99"},
    {"map", kAllScalars, 1, 99, false, "1 to 99"},
    {"table", kAllScalars, 1, 99, false, "1 to 99"},
}};
constexpr std::array<std::string_view, 10> kScalarNames = {"u8",  "i8",  "u16", "i16", "u32",
                                                           "i32", "u64", "i64", "f32", "f64"};
constexpr std::array<std::string_view, 4> kEncodingNames = {"text", "binary", "zstd", "jpeg"};

const TypeRule& rule_of(MatrixType type) {
  return kTypes[static_cast<std::size_t>(type) - 1];
}

}  // namespace

std::string_view name(MatrixType type) {
  return rule_of(type).name;
}
std::string_view name(Scalar scalar) {
  return kScalarNames[static_cast<std::size_t>(scalar)];
}
std::string_view name(Encoding encoding) {
  return kEncodingNames[static_cast<std::size_t>(encoding)];
}

std::optional<MatrixType> matrix_type_of(std::string_view name) {
  const auto found = std::ranges::find(kTypes, name, &TypeRule::name);
  if (found == kTypes.end()) return std::nullopt;
  return static_cast<MatrixType>(found - kTypes.begin() + 1);
}

std::optional<Scalar> scalar_of(std::string_view name) {
  return enum_named<Scalar>(kScalarNames, name);
}

std::optional<Encoding> encoding_of(std::string_view name) {
  return enum_named<Encoding>(kEncodingNames, name);
}

std::string matrix_text(const Info& info, std::optional<std::int32_t> width,
                        std::optional<std::int32_t> height) {
  auto side = [](std::optional<std::int32_t> given) {
    return given ? std::to_string(*given) : "any";
  };
  std::string text{name(info.type)};
  if (width || height) text += " " + side(width) + " x " + side(height);
  return text + " of " + std::to_string(info.components) + " x " + std::string(name(info.scalar));
}

int broken_rule(const Info& info) {
  auto type = static_cast<std::size_t>(info.type);
  if (type < 1 || type > kTypes.size()) return 17;
  const TypeRule& rule = rule_of(info.type);
  if (info.components < rule.least || info.components > rule.most ||
      (rule.by_threes && info.components % 3 != 0))
    return 18;
  if ((rule.scalars >> static_cast<unsigned>(info.scalar) & 1U) == 0) return 19;
  if (info.encoding > Encoding::Jpeg) return 20;
  if (info.encoding < Encoding::Jpeg) return 0;
  bool is_picture = (info.type == MatrixType::RgbImage && info.components == 3) ||
                    info.type == MatrixType::IntensityImage;
  return is_picture && info.scalar == Scalar::U8 ? 0 : 21;
}

std::optional<InfoError> find_error(const Info& info) {
  int rule = broken_rule(info);
  if (rule == 0) return std::nullopt;
  if (rule == 17)
    return InfoError{
        17, std::to_string(static_cast<int>(info.type)) + " is not a matrix type (1 to 12)"};

  std::string type{name(info.type)};
  std::string components = std::to_string(info.components);
  switch (rule) {
    case 18:
      return InfoError{18, type + " has " + std::string(rule_of(info.type).components_in_words) +
                               " components, not " + components};
    case 19:
      return InfoError{19, type + " has no scalar " + std::string(name(info.scalar))};
    case 20:
      return InfoError{20, "encoding " + std::to_string(static_cast<int>(info.encoding)) +
                               " is reserved (0 text, 1 binary, 2 zstd, 3 jpeg)"};
    default:
      return InfoError{rule,
                       "jpeg is for images of 1 or 3 components of u8, not " + matrix_text(info)};
  }
}

std::optional<InfoError> parse_info(std::int64_t code, Info& info) {
  if (code < 10000 || code > 129999)
    return InfoError{17,
                     "info " + std::to_string(code) + " has no matrix type (TTCCSE, TT 1 to 12)"};
  info = {static_cast<MatrixType>(code / 10000), static_cast<std::uint8_t>(code / 100 % 100),
          static_cast<Scalar>(code / 10 % 10), static_cast<Encoding>(code % 10)};
  return find_error(info);
}

}  // namespace hc
