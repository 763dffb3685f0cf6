// SPDX-License-Identifier: Apache-2.0
#pragma once
// Where a camera's pictures come from: everything that OpenCV opens, and folders of pictures.

#include <memory>
#include <string>

#include <opencv2/core.hpp>

/// A sequence of pictures. A source that cannot be opened, or breaks, throws hc::ModuleError.
class PictureSource {
 public:
  virtual ~PictureSource() = default;
  /// The next picture, (H, W, 3) u8 in OpenCV's order blue, green, red; empty at the end.
  virtual cv::Mat next() = 0;
  /// Starts again from the beginning; false for a source that has none, as a device.
  virtual bool rewind() = 0;
};

/// Opens a source by what its name is: a number or /dev/videoN a V4L2 device, a text with `!` a
/// GStreamer pipeline (with an appsink at its end), a folder its pictures in the order of their
/// names, a picture itself, anything else (a video file, an RTSP address) what OpenCV makes of it.
std::unique_ptr<PictureSource> open_picture_source(const std::string& name);
