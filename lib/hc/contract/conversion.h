// SPDX-License-Identifier: Apache-2.0
#pragma once
// What a sender makes of each message before it goes onto a link: smaller images, another encoding.
// Options of a link's URI, which the transports do not know. Pure.

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include <hc/base/result.h>
#include <hc/base/uri.h>
#include <hc/contract/port_type.h>
#include <hc/mtp/header.h>

namespace hc {

struct Conversion {
  std::optional<Encoding> as;  ///< nothing: as the output sends it
  std::optional<int> quality;  ///< of JPEG, 1 … 100
  double scale = 1;            ///< of width and height, 0.01 … 1

  [[nodiscard]] bool is_none() const { return !as && scale == 1; }
};

/// The options that say so, in the order in which they are read.
inline constexpr std::array<std::string_view, 3> kConversionOptions = {"as", "quality", "scale"};

/// Takes `as=`, `quality=` and `scale=` out of a URI's options.
///
/// Errors: Invalid; also for a quality without as=jpeg.
Result<Conversion> take_conversion(Uri& uri);

/// Whether images of that kind can be made smaller: pixels of u8 or u16, whose mean is a
/// brightness. (What f32 holds may be a depth, 0 where it is unknown.)
bool can_scale(const Info& info);

/// Why the messages of an output cannot be converted, or come to an input with another size than it
/// takes; empty where nothing hinders it, or nobody knows since a port takes anything.
std::string hindrance(const Conversion& conversion, const std::vector<PortType>& given,
                      const std::vector<PortType>& taken);

/// Width or height of what is left of so many pixels, 1 at least.
std::int32_t scaled(std::int32_t pixels, double scale);

}  // namespace hc
