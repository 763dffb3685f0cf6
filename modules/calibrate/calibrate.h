// SPDX-License-Identifier: Apache-2.0
#pragma once
// How a head's eyes are mounted on its pan-tilt unit, from what they see as it turns. No messages.

#include <stop_token>
#include <vector>

#include <gaze/eyes.h>
#include <hc/base/result.h>
#include <vision/calibration.h>
#include <opencv2/core.hpp>

/// What both eyes see in one pose of the head.
struct HeadView {
  hc::gaze::Angles unit;  ///< as the unit reports it
  cv::Mat first, second;  ///< (H, W) u8, of the cameras as they are plugged in
};

/// @param views  the first straight ahead; others a pan or a tilt away, so that images overlap by
///     half; at least one of each.
/// @param cameras  of the left and the right eye, as far as they are known.
/// @param mounted  the eyes as they are mounted on the head, about.
///
/// The unit's axes are seen as those that the images turn about: of each turn of the unit, by the
/// vector w in the head's frame, an eye sees the turn u = Mᵀ w, and M, which is how the eye sits in
/// the head, comes out of several. Where `cameras` were measured, and what is seen does not speak
/// against it, the offset is theirs: a chessboard measures it better.
///
/// Source: Kabsch, A solution for the best rotation to relate two sets of vectors, 1976.
/// A pose in which an eye sees too little of what it saw from the first is ignored.
/// Errors: NotFound (too little is seen by both eyes, or of turns about one axis); Unsupported
/// (images of another size than the cameras'); Stopped (`stop` was asked for).
/// Cost: 2 to 4 s of nine views at 800×600.
hc::Result<hc::gaze::HeadCalibration> calibrate(const std::vector<HeadView>& views,
                                                const hc::vision::StereoCalibration& cameras,
                                                const hc::gaze::Eyes& mounted,
                                                std::stop_token stop = {});
