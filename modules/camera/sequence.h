// SPDX-License-Identifier: Apache-2.0
#pragma once
// Images from files, folders, videos, and the streams and pipelines that OpenCV opens.

#include <memory>
#include <string>

#include <opencv2/core.hpp>

/// A sequence of images. Throws hc::ModuleError if it cannot be opened or read.
class ImageSequence {
 public:
  virtual ~ImageSequence() = default;
  /// The next image, (H, W, 3) u8 blue, green, red; empty at the end. Do not write to it: it may be
  /// returned again.
  virtual cv::Mat next() = 0;
  /// Starts again from the beginning.
  virtual void rewind() = 0;
};

/// Opens a GStreamer pipeline (a name with `!`, ending in an appsink), a folder (its images in the
/// order of their names), an image file, or anything else that OpenCV opens (video file, URL).
std::unique_ptr<ImageSequence> open_sequence(const std::string& name);
