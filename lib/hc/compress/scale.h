// SPDX-License-Identifier: Apache-2.0
#pragma once
// Smaller images, before they go onto a link. No state between calls, any thread.

#include <cstdint>

#include <hc/base/result.h>
#include <hc/mtp/message.h>

namespace hc {

/// The image with another size: each pixel is the mean of what it covers, its edges in proportion.
/// All of the header but width and height stays.
///
/// @param image  an image of u8 or u16; compressed elements are expanded first.
/// @param width, height  [px], from 1 to those of the image.
///
/// Errors: as expand(). Another kind or size of image is a bug. Cost: linear in the image's pixels.
Result<Message> shrink(const Message& image, std::int32_t width, std::int32_t height);

}  // namespace hc
