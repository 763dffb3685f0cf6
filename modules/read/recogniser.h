// SPDX-License-Identifier: Apache-2.0
#pragma once
// Reads a line of letters by Tesseract's neural network (LSTM). One thread.

#include <memory>
#include <string>
#include <vector>

#include <hc/base/result.h>
#include <opencv2/core.hpp>

/// A letter that was read, of those that are one byte in UTF-8 (ASCII).
struct Letter {
  char letter = ' ';
  double confidence = 0;     ///< [%]
  bool begins_word = false;  ///< preceded by a space, or nothing
  bool is_known = false;     ///< its word is in Tesseract's dictionary
};

struct Reading {
  std::string text;             ///< UTF-8, without space around it; may be empty
  double confidence = 0;        ///< 0 … 1
  std::vector<Letter> letters;  ///< what the text is made of, but for other letters
};

class Recogniser {
 public:
  /// Loads a language, which takes about 0.1 s.
  ///
  /// @param language  as Tesseract calls it: "eng", "deu", "eng+deu".
  /// @param upper_case  take nothing but capital letters, digits, space and - . , ! ?
  ///
  /// Errors: NotFound (no data of this language).
  static hc::Result<Recogniser> make(const std::string& language, bool upper_case);

  Recogniser(Recogniser&&) noexcept;
  Recogniser& operator=(Recogniser&&) noexcept;
  ~Recogniser();

  /// @param line  (H, W) u8, black letters about 40 pixels high on white, level, with a margin.
  /// Cost: 30 … 150 ms on one core.
  Reading read(const cv::Mat& line);

 private:
  struct Engine;
  explicit Recogniser(std::unique_ptr<Engine> engine);
  std::unique_ptr<Engine> engine_;
};
