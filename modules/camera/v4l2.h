// SPDX-License-Identifier: Apache-2.0
#pragma once
// The settings of a V4L2 device as OpenCV properties. Pure.

#include <string>
#include <vector>

#include <hc/base/result.h>

#include "live.h"

/// The mode requested when a camera is opened; 0 and "": the camera's default.
struct CaptureMode {
  int width = 0, height = 0;  ///< [px]
  double rate = 0;            ///< [1/s]
  std::string pixel_format;   ///< aravis: GenICam name; V4L2: FourCC, e.g. MJPG
};

/// A value for an OpenCV property.
struct Setting {
  int property = 0;
  double value = 0;
  std::string refusal;  ///< error if the device refuses it; "": ignored
};

/// Settings of a device when it was opened.
struct Found {
  double exposure = 0, gain = 0;  ///< in OpenCV's units; < 0: not supported
};

/// The settings when a device is opened, in this order: format, size, rate, since the sizes depend
/// on the format and the rates on the size.
///
/// Errors: Unsupported (a format that is not a FourCC).
hc::Result<std::vector<Setting>> settings_to_open(const CaptureMode& mode);

/// The settings while a device runs, in order. Automatic exposure falls back to the exposure found
/// at the start; automatic gain is always the gain found, since OpenCV cannot set
/// V4L2_CID_AUTOGAIN.
std::vector<Setting> settings_of(const Adjustment& adjustment, const Found& found);

/// Describes a mode that differs from the requested one: "gives 640 x 480 pixels instead of
/// 800 x 600"; "" if it does not.
std::string difference(const CaptureMode& asked, int width, int height, double fourcc);

/// How long a device may be silent until it counts as lost [s]: 2, or two periods if longer.
int silence_of(const CaptureMode& mode);
