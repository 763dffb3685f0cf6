// SPDX-License-Identifier: Apache-2.0
#pragma once
// Two cameras that differ, with distortion and a squint, for tests.

#include <vision/calibration.h>
#include <opencv2/calib3d.hpp>

namespace hc::vision {

inline StereoCalibration squinting() {
  StereoCalibration truth = ideal_pair({800, 600}, 600, 0.1);
  truth.M2(0, 0) = truth.M2(1, 1) = 610;
  truth.M2(0, 2) += 8;
  truth.D1 = {-0.2, 0.05, 0.001, -0.0005, 0};
  truth.D2 = {-0.18, 0.04, 0, 0.0005, 0};
  cv::Rodrigues(cv::Vec3d(0.01, 0.05, -0.02), truth.R);
  truth.T = {-0.1, 0.002, 0.004};
  rectify(truth);
  return truth;
}

}  // namespace hc::vision
