// SPDX-License-Identifier: Apache-2.0
#pragma once
// The image of a person's head: a photograph that is warped and dyed. Pure.

#include <opencv2/core.hpp>

#include <room/looks.h>

namespace hc::room {

/// The image around make_head(): (H, W, 3) u8, red, green, blue; the face is in its middle.
/// Cost: 50 ms.
cv::Mat paint_head(const Look& look);

/// The colour of a look's skin, red, green, blue.
cv::Scalar skin_of(const Look& look);

}  // namespace hc::room
