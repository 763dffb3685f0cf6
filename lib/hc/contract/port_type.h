// SPDX-License-Identifier: Apache-2.0
#pragma once
// Types of ports, and whether messages and links match them. Pure.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <hc/mtp/header.h>

namespace hc {

/// A type of message: its elements and, if fixed, shape and coordinate system.
struct PortType {
  Info info;                ///< the encoding is the default of an output
  std::int32_t width = 0;   ///< 0: any
  std::int32_t height = 0;  ///< 0: any
  std::int32_t coord = 0;   ///< 0: any
  bool finite = false;      ///< an input drops and counts messages with NaN or infinity
};

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

/// Why a message is not of a type: Malformed; the detail begins with the rule of the field,
/// "R19: …". A message that fits is a bug.
Error misfit(const Header& header, const PortType& type);
/// The same for several types; of more than one, the detail names no rule: "table 2 x 1 of 1 x f64
/// does not fit, the port takes …".
Error misfit(const Header& header, const std::vector<PortType>& types);

/// Whether an output of type `given` may be linked to an input that takes `taken`; an empty list
/// means any type.
bool fits(const std::vector<PortType>& given, const std::vector<PortType>& taken);

/// "table 2 x 1 of 1 x f64 in coordinate system left_rectified (9)".
std::string in_words(const Header& header);
/// "rgb_image of 3 x u8 in coordinate system left_rectified (9)"; several joined by "or", none:
/// "anything".
std::string in_words(const PortType& type);
std::string in_words(const std::vector<PortType>& types);

}  // namespace hc
