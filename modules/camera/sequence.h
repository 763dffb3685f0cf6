// SPDX-License-Identifier: Apache-2.0
#pragma once
// Images from files, folders, videos, and the streams and pipelines that OpenCV opens.

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include <opencv2/core.hpp>

/// An image of a sequence, (H, W, 3) u8 blue, green, red; empty at the end.
struct SequenceImage {
  cv::Mat image;  ///< not to be written to: it may be returned again
  /// Its time in the video; none if it is not of a video file.
  std::optional<std::chrono::nanoseconds> at = {};
};

/// A sequence of images. Throws hc::ModuleError if it cannot be opened or read; a single image file
/// that is being replaced stays as it was until it can be read.
class ImageSequence {
 public:
  virtual ~ImageSequence() = default;
  virtual SequenceImage next() = 0;
  /// Starts again from the beginning.
  virtual void rewind() = 0;
  /// Of a video file: when the last image so far ends; none if the images have no times.
  [[nodiscard]] virtual std::optional<std::chrono::nanoseconds> length() const { return {}; }
};

/// How files are read.
struct Reading {
  /// Turn images and videos as their EXIF data or metadata says.
  bool upright = true;
  /// Takes a line for the log, and what is counted after the first one.
  std::function<void(const char* kind, const std::string& line)> log = [](const char*,
                                                                          const std::string&) {};
};

/// Opens a GStreamer pipeline (a name with `!`, ending in an appsink), a folder (its images in the
/// natural order of their names: 2 before 10), an image file, or anything else that OpenCV opens
/// (video file, URL, pattern).
std::unique_ptr<ImageSequence> open_sequence(const std::string& name, const Reading& reading);

/// The sequences of two eyes.
struct SequencePair {
  std::unique_ptr<ImageSequence> left, right;
  std::string remark = {};  ///< which images of two folders have no partner; "": all have one
};

/// Opens the sequences of two eyes. Of two folders it takes the images that have a partner; see
/// partners_of(). Throws hc::ModuleError as open_sequence() does, and if no image has a partner.
SequencePair open_sequences(const std::string& left, const std::string& right,
                            const Reading& reading);
