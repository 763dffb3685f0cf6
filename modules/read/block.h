// SPDX-License-Identifier: Apache-2.0
#pragma once
// Reads what is on a board: one line or several.

#include <vector>

#include <vision/letters.h>
#include <opencv2/core.hpp>

#include "recogniser.h"

/// What is written in the lines of a block, joined by spaces, as sure as the least sure line.
/// @param image  (H, W, 3) or (H, W, 1) u8.
/// @param upper_case  there is nothing but what Recogniser::make says of it.
hc::vision::Reading read_block(Recogniser& recogniser, const cv::Mat& image,
                               const std::vector<hc::vision::TextLine>& block, bool upper_case);
