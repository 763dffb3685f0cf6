// SPDX-License-Identifier: Apache-2.0
#pragma once
// Converts the pixels of GenICam cameras to images. Pure.

#include <cstdint>
#include <span>

#include <hc/base/result.h>
#include <opencv2/core.hpp>

namespace hc::aravis {

/// Numbers of the EMVA's Pixel Format Naming Convention.
enum class PixelFormat : std::uint32_t {
  Mono8 = 0x01080001,
  BayerGR8 = 0x01080008,
  BayerRG8 = 0x01080009,
  BayerGB8 = 0x0108000A,
  BayerBG8 = 0x0108000B,
  Rgb8 = 0x02180014,
  Bgr8 = 0x02180015,
};

/// Whether to_bgr() supports a format.
bool is_known(std::uint32_t format);

/// Converts pixels to an image with separate memory.
///
/// @param pixels  bytes beyond the image are ignored.
/// @param padding  after each row [byte].
/// @returns  (height, width, 3) u8: blue, green, red; Bayer patterns are interpolated.
///
/// Errors: Unsupported (the format), Malformed (too few bytes for the size).
Result<cv::Mat> to_bgr(std::uint32_t format, int width, int height,
                       std::span<const std::byte> pixels, int padding = 0);

}  // namespace hc::aravis
