// SPDX-License-Identifier: Apache-2.0
#pragma once
// What a port takes or gives, and what fits it. Pure.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <hc/mtp/header.h>

namespace hc {

/// A type of messages: elements, and shape and coordinate system where they are fixed.
struct PortType {
  Info info;                ///< the encoding is the default of an output
  std::int32_t width = 0;   ///< 0: any
  std::int32_t height = 0;  ///< 0: any
  std::int32_t coord = 0;   ///< 0: any
  bool finite = false;      ///< an input drops messages with NaN or infinity, and counts them
};

/// Whether a message fits a type.
inline bool fits(const Header& header, const PortType& type) {
  return header.info.type == type.info.type && header.info.components == type.info.components &&
         header.info.scalar == type.info.scalar &&
         (type.width == 0 || header.width == type.width) &&
         (type.height == 0 || header.height == type.height) &&
         (type.coord == 0 || header.coord == 0 || header.coord == type.coord);
}

/// Height and width.
using Shape = std::pair<std::int32_t, std::int32_t>;

/// The shape of so many numbers of a type: the sides that it fixes, else one row; of a dense graph
/// a square, of a sparse one a column of edges. None where the count does not fit.
std::optional<Shape> shape_of(const PortType& type, std::size_t numbers);

/// Why a message does not fit a type: Malformed; the detail begins with the rule of the field,
/// "R19: …". A message that fits is a bug.
Error misfit(const Header& header, const PortType& type);

/// Whether an output that gives `given` may be linked to an input that takes `taken`; an empty list
/// is anything.
bool fits(const std::vector<PortType>& given, const std::vector<PortType>& taken);

/// "rgb_image of 3 x u8 in coordinate system left_rectified (9)"; several with "or" between them,
/// none: "anything".
std::string in_words(const PortType& type);
std::string in_words(const std::vector<PortType>& types);

}  // namespace hc
