// SPDX-License-Identifier: Apache-2.0
#pragma once
// Downscaling of images. Stateless, any thread.

#include <cstdint>

#include <hc/base/result.h>
#include <hc/mtp/message.h>

namespace hc {

/// The image scaled down; each pixel is the area-weighted mean of those that it covers. The header
/// is unchanged except for width and height.
///
/// @param image  an image of u8 or u16; compressed elements are expanded first.
/// @param width, height  [px], at most those of the image.
///
/// Errors: as expand(). Images of other scalars or larger sizes are bugs. Cost: linear in the
/// pixels of the image.
Result<Message> shrink(const Message& image, std::int32_t width, std::int32_t height);

}  // namespace hc
