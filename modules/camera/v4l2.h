// SPDX-License-Identifier: Apache-2.0
#pragma once
// What a V4L2 device is to be set to, as OpenCV's properties. Pure.

#include <string>
#include <vector>

#include <hc/base/result.h>

#include "live.h"

/// What a camera is asked for when it is opened; 0 and "": what it has.
struct CaptureMode {
  int width = 0, height = 0;  ///< [px]
  double rate = 0;            ///< [1/s]
  std::string pixel_format;   ///< of aravis: as GenICam calls it; of V4L2: a FourCC, as MJPG
};

/// One of OpenCV's properties.
struct Setting {
  int property = 0;
  double value = 0;
  std::string refusal;  ///< what is to be said when the device refuses it; "": nothing
};

/// How a device was when it was opened.
struct Found {
  double exposure = 0, gain = 0;  ///< as OpenCV counts them; less than 0: it has none
};

/// What is to be set in this order when a device is opened. The format comes first, since each has
/// sizes of its own, and the rate last, since each size has rates of its own.
///
/// Errors: Unsupported (a format that is no FourCC).
hc::Result<std::vector<Setting>> settings_to_open(const CaptureMode& mode);

/// What is to be set in this order while it runs. Its own choice of the exposure is the automatic
/// one, of a device that has it, else what was found; that of the gain is what was found, since
/// OpenCV does not reach V4L2_CID_AUTOGAIN.
std::vector<Setting> settings_of(const Adjustment& adjustment, const Found& found);

/// What to log when a device does not do as it was asked: "gives 640 x 480 pixels instead of
/// 800 x 600"; "" when it does.
std::string difference(const CaptureMode& asked, int width, int height, double fourcc);

/// How long a device may be silent at one image until it is lost [s]: 2, or two periods.
int silence_of(const CaptureMode& mode);
