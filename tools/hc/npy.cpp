// SPDX-License-Identifier: Apache-2.0
#include "npy.h"

#include <charconv>
#include <cstring>
#include <optional>
#include <vector>

namespace tool {
namespace {

hc::Error malformed(const std::string& what) {
  return {hc::Code::Malformed, "npy: " + what};
}

std::optional<hc::Scalar> scalar_of_descr(std::string_view descr) {
  struct Name {
    std::string_view descr;
    hc::Scalar scalar;
  };
  using hc::Scalar;
  constexpr Name kNames[] = {{"|u1", Scalar::U8},  {"|i1", Scalar::I8},  {"|b1", Scalar::U8},
                             {"<u2", Scalar::U16}, {"<i2", Scalar::I16}, {"<u4", Scalar::U32},
                             {"<i4", Scalar::I32}, {"<u8", Scalar::U64}, {"<i8", Scalar::I64},
                             {"<f4", Scalar::F32}, {"<f8", Scalar::F64}};
  for (const Name& each : kNames)
    if (each.descr == descr) return each.scalar;
  return std::nullopt;
}

/// The text after `'key':` in the dictionary, a Python literal.
std::string_view entry(std::string_view dictionary, std::string_view key) {
  auto at = dictionary.find("'" + std::string(key) + "'");
  if (at == std::string_view::npos) return {};
  at = dictionary.find(':', at);
  if (at == std::string_view::npos) return {};
  at = dictionary.find_first_not_of(' ', at + 1);
  return at == std::string_view::npos ? std::string_view{} : dictionary.substr(at);
}

/// Parses "(2, 3)", "(5,)" or "()".
std::optional<std::vector<std::int32_t>> shape_of(std::string_view text) {
  auto close = text.find(')');
  if (!text.starts_with('(') || close == std::string_view::npos) return std::nullopt;
  text = text.substr(1, close - 1);
  std::vector<std::int32_t> shape;
  while (true) {
    auto begin = text.find_first_not_of(" ,");
    if (begin == std::string_view::npos) return shape;
    text.remove_prefix(begin);
    std::int32_t side = 0;
    auto [stop, status] = std::from_chars(text.data(), text.data() + text.size(), side);
    if (status != std::errc() || side < 0) return std::nullopt;
    shape.push_back(side);
    text.remove_prefix(static_cast<std::size_t>(stop - text.data()));
  }
}

}  // namespace

hc::Result<hc::Message> read_npy(std::span<const std::byte> bytes) {
  constexpr std::string_view kMagic = "\x93NUMPY";
  std::string_view text{reinterpret_cast<const char*>(bytes.data()), bytes.size()};
  if (!text.starts_with(kMagic) || text.size() < 12) return malformed("not a NumPy array file");
  bool wide = text[6] != 1;  // the length has 2 bytes in version 1.0, 4 in later ones
  auto byte = [&](std::size_t i) {
    return static_cast<std::size_t>(static_cast<unsigned char>(text[i]));
  };
  std::size_t length = byte(8) | byte(9) << 8;
  if (wide) length |= byte(10) << 16 | byte(11) << 24;
  std::size_t begin = wide ? 12 : 10;
  if (length > text.size() - begin) return malformed("truncated header");
  std::string_view dictionary = text.substr(begin, length);
  std::string_view data = text.substr(begin + length);

  std::string_view descr = entry(dictionary, "descr");
  auto scalar = descr.size() > 4 ? scalar_of_descr(descr.substr(1, 3)) : std::nullopt;
  if (!scalar)
    return hc::Error{hc::Code::Unsupported,
                     "npy: unsupported element type " + std::string(descr.substr(0, 12))};
  if (!entry(dictionary, "fortran_order").starts_with("False"))
    return hc::Error{hc::Code::Unsupported, "npy: column-major order (fortran_order)"};
  auto shape = shape_of(entry(dictionary, "shape"));
  if (!shape || shape->size() > 3) return malformed("the shape must have at most three dimensions");

  hc::Header header;
  header.height = shape->size() > 1 ? (*shape)[0] : 1;
  header.width = shape->empty() ? 1 : shape->size() == 1 ? (*shape)[0] : (*shape)[1];
  std::int32_t components = shape->size() == 3 ? (*shape)[2] : 1;
  if (components < 1 || components > 99) return malformed("a message has 1 to 99 components");
  bool is_image = components == 3 && *scalar == hc::Scalar::U8;
  header.info = {is_image ? hc::MatrixType::RgbImage : hc::MatrixType::Table,
                 static_cast<std::uint8_t>(components), *scalar, hc::Encoding::Binary};
  if (auto valid = hc::check(header); !valid) return valid.error();
  if (data.size() != header.element_bytes())
    return malformed("expected " + std::to_string(header.element_bytes()) + " bytes of data, got " +
                     std::to_string(data.size()));
  hc::Draft draft = hc::Draft::make(header);
  if (!data.empty()) std::memcpy(draft.elements().data(), data.data(), data.size());
  return std::move(draft).finish();
}

}  // namespace tool
