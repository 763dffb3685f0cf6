// SPDX-License-Identifier: Apache-2.0
#include <hc/contract/port_type.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include <hc/mtp/coords.h>

namespace hc {
namespace {

Error misfit_of(int rule, std::string_view field, const std::string& has,
                const std::string& wanted) {
  std::string detail = "R" + std::to_string(rule) + " ";
  detail.append(field).append(": ").append(has).append(" does not fit, the port takes ");
  return {Code::Malformed, detail + wanted};
}

}  // namespace

std::optional<Shape> shape_of(const PortType& type, std::size_t numbers) {
  const auto elements = static_cast<std::int32_t>(numbers / type.info.components);
  std::int32_t height = type.height, width = type.width;
  if (type.info.type == MatrixType::DenseGraph && height == 0 && width == 0)
    height = width = static_cast<std::int32_t>(std::lround(std::sqrt(elements)));
  else if (type.info.type == MatrixType::SparseGraph && width == 0)
    width = 1;
  if (height == 0) height = width == 0 ? 1 : elements / width;
  if (width == 0) width = elements / height;
  const auto all = static_cast<std::size_t>(height) * static_cast<std::size_t>(width);
  if (all * type.info.components != numbers) return std::nullopt;
  return Shape{height, width};
}

Error misfit(const Header& header, const PortType& type) {
  const Info& info = header.info;
  if (info.type != type.info.type)
    return misfit_of(17, "info", std::string(name(info.type)), std::string(name(type.info.type)));
  if (info.components != type.info.components)
    return misfit_of(18, "info", std::to_string(info.components) + " components",
                     std::to_string(type.info.components));
  if (info.scalar != type.info.scalar)
    return misfit_of(19, "info", std::string(name(info.scalar)),
                     std::string(name(type.info.scalar)));
  if (type.width != 0 && header.width != type.width)
    return misfit_of(15, "width", std::to_string(header.width), std::to_string(type.width));
  if (type.height != 0 && header.height != type.height)
    return misfit_of(16, "height", std::to_string(header.height), std::to_string(type.height));
  HC_CHECK(!fits(header, type), text(header));
  return misfit_of(44, "coord", "coordinate system " + coord_and_number(header.coord),
                   coord_and_number(type.coord));
}

Error misfit(const Header& header, const std::vector<PortType>& types) {
  if (types.size() == 1) return misfit(header, types.front());
  return {Code::Malformed, in_words(header) + " does not fit, the port takes " + in_words(types)};
}

bool fits(const std::vector<PortType>& given, const std::vector<PortType>& taken) {
  auto same = [](std::int32_t a, std::int32_t b) { return a == 0 || b == 0 || a == b; };
  if (given.empty() || taken.empty()) return true;
  const PortType& from = given.front();
  return std::any_of(taken.begin(), taken.end(), [&](const PortType& to) {
    return from.info.type == to.info.type && from.info.scalar == to.info.scalar &&
           from.info.components == to.info.components && same(from.width, to.width) &&
           same(from.height, to.height) && same(from.coord, to.coord);
  });
}

std::string in_words(const Header& header) {
  std::string text = matrix_text(header.info, header.width, header.height);
  if (header.coord != 0) text += " in coordinate system " + coord_and_number(header.coord);
  return text;
}

std::string in_words(const PortType& type) {
  auto side = [](std::int32_t given) { return given != 0 ? std::optional(given) : std::nullopt; };
  std::string text = matrix_text(type.info, side(type.width), side(type.height));
  if (type.coord != 0) text += " in coordinate system " + coord_and_number(type.coord);
  return text;
}

std::string in_words(const std::vector<PortType>& types) {
  std::string text = types.empty() ? "anything" : "";
  for (const auto& type : types) text.append(text.empty() ? "" : " or ").append(in_words(type));
  return text;
}

}  // namespace hc
