// SPDX-License-Identifier: Apache-2.0
#pragma once
// Images of files: image files, folders of them, videos, streams and pipelines that OpenCV opens.

#include <memory>
#include <string>

#include <opencv2/core.hpp>

/// A sequence of images. One that cannot be opened, or breaks, throws hc::ModuleError.
class ImageSequence {
 public:
  virtual ~ImageSequence() = default;
  /// The next image, (H, W, 3) u8 in OpenCV's order blue, green, red; empty at the end. Not to be
  /// written to: it may be given again.
  virtual cv::Mat next() = 0;
  /// Starts again from the beginning.
  virtual void rewind() = 0;
};

/// Opens a sequence by its name: a text with `!` a GStreamer pipeline (with an appsink at its end),
/// a folder its images in the order of their names, an image itself, anything else (a video file,
/// an address) what OpenCV makes of it.
std::unique_ptr<ImageSequence> open_sequence(const std::string& name);
