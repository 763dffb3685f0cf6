// SPDX-License-Identifier: Apache-2.0
#pragma once
// How a head's eyes sit on its pan-tilt unit, from what they see as it turns. No messages.

#include <vector>

#include <gaze/aim.h>
#include <hc/base/result.h>
#include <vision/motion.h>
#include <opencv2/core.hpp>

/// What both eyes see from one stand of the head.
struct HeadView {
  hc::gaze::Angles unit;  ///< as the unit reports it
  cv::Mat first, second;  ///< (H, W) u8, of the cameras as they are plugged in
};

/// What is found.
struct HeadCalibration {
  bool swapped = false;   ///< the first camera is the right eye
  hc::gaze::Angles zero;  ///< where the left eye looks with the unit at 0
  double offset_roll = 0, offset_pitch = 0,
         offset_yaw = 0;  ///< of the right eye, about the left one's z, x and y [rad]
  double rms = 0;         ///< of the matches between the eyes [px]
};

/// @param views  the first straight ahead; others a pan or a tilt away, so that pictures overlap by
///     half; at least one of each.
/// @param middle  of the eyes in the head, about [m]. @param baseline  their distance [m].
///
/// The unit's axes are seen as those that the pictures turn about: of each turn of the unit, by the
/// vector w in the head's frame, an eye sees the turn u = Mᵀ w, and M, which is how the eye sits in
/// the head, comes out of several.
///
/// Source: Kabsch, A solution for the best rotation to relate two sets of vectors, 1976.
/// Errors: NotFound (two pictures in which too little is found that is the same).
hc::Result<HeadCalibration> calibrate(const std::vector<HeadView>& views,
                                      const hc::vision::Intrinsics& camera,
                                      const Eigen::Vector3d& middle, double baseline);
