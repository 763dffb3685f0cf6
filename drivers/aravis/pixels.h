// SPDX-License-Identifier: Apache-2.0
#pragma once
// The pixels of GenICam cameras as images. Pure.

#include <cstdint>
#include <span>

#include <hc/base/result.h>
#include <opencv2/core.hpp>

namespace hc::aravis {

/// Formats as the Pixel Format Naming Convention of the EMVA numbers them.
enum class PixelFormat : std::uint32_t {
  Mono8 = 0x01080001,
  BayerGR8 = 0x01080008,
  BayerRG8 = 0x01080009,
  BayerGB8 = 0x0108000A,
  BayerBG8 = 0x0108000B,
  Rgb8 = 0x02180014,
  Bgr8 = 0x02180015,
};

/// Whether to_bgr() takes a format.
bool is_known(std::uint32_t format);

/// An image of a camera's pixels, in memory of its own.
///
/// @param pixels  more than an image is ignored.
/// @param padding  after each row [byte].
/// @returns  (height, width, 3) u8: blue, green, red. Bayer's colours are interpolated.
///
/// Errors: Unsupported (the format), Malformed (too few bytes for the size).
Result<cv::Mat> to_bgr(std::uint32_t format, int width, int height,
                       std::span<const std::byte> pixels, int padding = 0);

}  // namespace hc::aravis
