// SPDX-License-Identifier: Apache-2.0
#pragma once
// Conversion of messages before they are sent over a link: downscaling of images, re-encoding, and
// which of them are sent at all.
// Options of a link's URI that transports do not see. Pure.

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
  std::optional<Encoding> as;  ///< nullopt: the encoding of the output
  std::optional<int> quality;  ///< of JPEG, 1 … 100
  double scale = 1;            ///< of width and height, 0.01 … 1
  double idle_rate = 0;        ///< while messages do not change [message/s]; 0: all are sent
  /// Links of one module that are adapted alike to their bandwidth; empty: each by itself.
  std::string pair;

  /// Whether messages are sent in the form that they have.
  [[nodiscard]] bool is_none() const { return !as && scale == 1; }
};

/// The options of a conversion, in the order in which they are parsed.
inline constexpr std::array<std::string_view, 5> kConversionOptions = {"as", "quality", "scale",
                                                                       "idle_rate", "pair"};

/// Removes `as=`, `quality=`, `scale=`, `idle_rate=` and `pair=` from a URI's options.
///
/// Errors: Invalid; also for a quality without as=jpeg.
Result<Conversion> take_conversion(Uri& uri);

/// Whether images of this type can be downscaled: pixels of u8 or u16, for which a mean makes
/// sense. (Images of f32 may be depth, with 0 where it is unknown.)
bool can_scale(const Info& info);

/// Why an output's messages cannot be converted, or will not have the size that an input takes;
/// empty if they can, or if it is unknown because a port takes anything.
std::string hindrance(const Conversion& conversion, const std::vector<PortType>& given,
                      const std::vector<PortType>& taken);

/// A width or height after scaling, at least 1. [px]
std::int32_t scaled(std::int32_t pixels, double scale);

}  // namespace hc
