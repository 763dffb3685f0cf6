// SPDX-License-Identifier: Apache-2.0
#pragma once
// Reads a line of text with Tesseract's neural network (LSTM). For one thread.

#include <memory>
#include <string>
#include <utility>

#include <hc/base/result.h>
#include <vision/letter_shapes.h>
#include <opencv2/core.hpp>

class Recogniser {
 public:
  /// Loads a language. Cost: about 0.1 s.
  ///
  /// @param language  Tesseract's name: "eng", "deu", "eng+deu".
  /// @param upper_case  only capital letters, digits, space and - . , ! ?
  ///
  /// Errors: NotFound (no data for this language).
  static hc::Result<Recogniser> make(const std::string& language, bool upper_case);

  /// @param line  (H, W) u8, black letters about 36 px high on white, horizontal, with a margin.
  /// Cost: 30 … 150 ms on one core.
  hc::vision::Reading read(const cv::Mat& line);

  /// Reads an image that contains a word, or a few, and hardly anything else.
  ///
  /// @param crop  (H, W) u8, dark letters on bright or bright ones on dark.
  /// Cost: as read().
  hc::vision::Reading read_crop(const cv::Mat& crop);

 private:
  struct Engine;
  explicit Recogniser(std::shared_ptr<Engine> engine) : engine_(std::move(engine)) {}
  hc::vision::Reading read_by(int segmentation, const cv::Mat& image);
  std::shared_ptr<Engine> engine_;
};
