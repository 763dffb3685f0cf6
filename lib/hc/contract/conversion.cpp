// SPDX-License-Identifier: Apache-2.0
#include <hc/contract/conversion.h>

#include <algorithm>
#include <cmath>

#include <hc/base/text.h>

namespace hc {
namespace {

constexpr double kSmallest = 0.01;
constexpr int kBestQuality = 100;
constexpr double kSlowest = 0.01, kFastest = 1000;  // idle_rate [message/s]

/// Parses an option if it is given; false if it is not a number in the range.
template <typename Number>
bool read(const Uri& uri, std::string_view key, Number min, Number max, Number& number) {
  const auto text = uri.option(key, "");
  return text.empty() || (read_number(text, number) && number >= min && number <= max);
}

Error invalid(std::string what) {
  return {Code::Invalid, std::move(what)};
}

}  // namespace

Result<Conversion> take_conversion(Uri& uri) {
  Conversion conversion;
  if (const auto as = uri.option("as", ""); !as.empty()) {
    conversion.as = encoding_of(as);
    if (!conversion.as) return invalid("option as is text, binary, zstd or jpeg");
  }
  int quality = 0;
  if (!read(uri, "quality", 1, kBestQuality, quality))
    return invalid("option quality is a whole number from 1 to 100");
  if (quality != 0) conversion.quality = quality;
  if (quality != 0 && conversion.as != Encoding::Jpeg)
    return invalid("option quality needs as=jpeg");
  if (!read(uri, "scale", kSmallest, 1.0, conversion.scale))
    return invalid("option scale is a number from 0.01 to 1");
  if (!read(uri, "idle_rate", kSlowest, kFastest, conversion.idle_rate))
    return invalid("option idle_rate is a number from 0.01 to 1000");
  conversion.pair = uri.option("pair", "");
  std::erase_if(uri.options, [](const auto& option) {
    return std::ranges::find(kConversionOptions, option.first) != kConversionOptions.end();
  });
  return conversion;
}

bool can_scale(const Info& info) {
  return (info.type == MatrixType::RgbImage || info.type == MatrixType::IntensityImage) &&
         (info.scalar == Scalar::U8 || info.scalar == Scalar::U16);
}

std::string hindrance(const Conversion& conversion, const std::vector<PortType>& given,
                      const std::vector<PortType>& taken) {
  if (given.empty()) return "";
  auto info = given.front().info;
  if (conversion.as) {
    info.encoding = *conversion.as;
    if (const auto broken = find_error(info))
      return "as: R" + std::to_string(broken->rule) + " " + broken->what;
  }
  if (conversion.scale == 1) return "";
  if (!can_scale(info)) return "scale is for images of u8 or u16, not " + in_words(given);
  const bool is_fixed = !taken.empty() && std::ranges::all_of(taken, [](const auto& type) {
    return type.width != 0 || type.height != 0;
  });
  return is_fixed ? "scale changes the size of images, and the input takes " + in_words(taken) : "";
}

std::int32_t scaled(std::int32_t pixels, double scale) {
  if (pixels <= 0) return pixels;
  return std::max(1, static_cast<std::int32_t>(std::lround(pixels * scale)));
}

}  // namespace hc
