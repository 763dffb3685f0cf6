// SPDX-License-Identifier: Apache-2.0
#include <drivers/aravis/pixels.h>

#include <optional>
#include <string>

#include <opencv2/imgproc.hpp>

namespace hc::aravis {
namespace {

struct Conversion {
  int type;  // of the raw matrix
  int code;  // for cvtColor, -1: none
};

std::optional<Conversion> conversion_of(std::uint32_t format) {
  switch (static_cast<PixelFormat>(format)) {
    case PixelFormat::Mono8:
      return Conversion{CV_8UC1, cv::COLOR_GRAY2BGR};
    // OpenCV names a pattern by its second row, from the second pixel.
    case PixelFormat::BayerRG8:
      return Conversion{CV_8UC1, cv::COLOR_BayerBG2BGR};
    case PixelFormat::BayerBG8:
      return Conversion{CV_8UC1, cv::COLOR_BayerRG2BGR};
    case PixelFormat::BayerGR8:
      return Conversion{CV_8UC1, cv::COLOR_BayerGB2BGR};
    case PixelFormat::BayerGB8:
      return Conversion{CV_8UC1, cv::COLOR_BayerGR2BGR};
    case PixelFormat::Rgb8:
      return Conversion{CV_8UC3, cv::COLOR_RGB2BGR};
    case PixelFormat::Bgr8:
      return Conversion{CV_8UC3, -1};
  }
  return {};
}

}  // namespace

bool is_known(std::uint32_t format) {
  return conversion_of(format).has_value();
}

Result<cv::Mat> to_bgr(std::uint32_t format, int width, int height,
                       std::span<const std::byte> pixels, int padding) {
  const auto conversion = conversion_of(format);
  if (!conversion)
    return Error{Code::Unsupported, "pixel format " + std::to_string(format) +
                                        " is not one of Mono8, RGB8, BGR8, 8-bit Bayer"};
  // Bayer interpolation needs two rows and columns.
  if (width < 2 || height < 2 || padding < 0)
    return Error{Code::Malformed,
                 "an image of " + std::to_string(width) + " x " + std::to_string(height)};
  const std::size_t row =
      static_cast<std::size_t>(width) * static_cast<std::size_t>(CV_ELEM_SIZE(conversion->type));
  const std::size_t step = row + static_cast<std::size_t>(padding);
  const std::size_t needed = step * static_cast<std::size_t>(height - 1) + row;
  if (pixels.size() < needed)
    return Error{Code::Malformed, std::to_string(pixels.size()) + " bytes, " +
                                      std::to_string(needed) + " needed for an image"};
  const cv::Mat raw(height, width, conversion->type, const_cast<std::byte*>(pixels.data()), step);
  if (conversion->code < 0) return raw.clone();
  cv::Mat bgr;
  cv::cvtColor(raw, bgr, conversion->code);
  return bgr;
}

}  // namespace hc::aravis
