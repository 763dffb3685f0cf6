// SPDX-License-Identifier: Apache-2.0
#pragma once
// What a port takes or gives, and what fits it. Pure.

#include <cstdint>
#include <string>
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
///
/// Errors: Malformed; the detail begins with the rule of the field that does not fit, "R19: …".
Status fits(const Header& header, const PortType& type);

/// Whether an output that gives `given` may be linked to an input that takes `taken`; an empty list
/// is anything.
bool fits(const std::vector<PortType>& given, const std::vector<PortType>& taken);

/// "rgb_image 3 x u8 in coordinate system 9"; several with "or" between them, none: "anything".
std::string in_words(const PortType& type);
std::string in_words(const std::vector<PortType>& types);

}  // namespace hc
