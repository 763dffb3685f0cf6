// SPDX-License-Identifier: Apache-2.0
#pragma once
// Calibrates the mounting of a head's eyes on its pan-tilt unit, by turning the head. No messages.

#include <stop_token>
#include <vector>

#include <gaze/eyes.h>
#include <hc/base/result.h>
#include <vision/calibration.h>
#include <opencv2/core.hpp>

/// Images of both eyes in one pose of the head.
struct HeadView {
  hc::gaze::Angles unit;  ///< reported by the unit [rad]
  cv::Mat first, second;  ///< (H, W) u8, in the order of the cameras, which may be swapped
};

/// @param views  the first straight ahead; the others differ in pan or tilt, with images that
///     overlap it by half; at least one of each.
/// @param cameras  intrinsics and, if measured, extrinsics of the left and right eye.
/// @param mounted  approximate mounting of the eyes on the head.
///
/// A turn of the unit by the rotation vector w in the head's frame appears to an eye as u = Mᵀ w;
/// several turns give M, the rotation of the eye in the head. If `cameras` were measured with a
/// chessboard and the images agree, the offset is theirs, which is more accurate. Poses with too
/// few matches to the first are ignored.
///
/// Source: Kabsch, A solution for the best rotation to relate two sets of vectors, 1976.
/// Errors: NotFound (too few matches between the eyes or while turning about one of the axes);
/// Unsupported (images of another size than the cameras'); Stopped (by `stop`). Cost: 2 to 4 s for
/// nine views at 800×600.
hc::Result<hc::gaze::HeadCalibration> calibrate(const std::vector<HeadView>& views,
                                                const hc::vision::StereoCalibration& cameras,
                                                const hc::gaze::Eyes& mounted,
                                                std::stop_token stop = {});
