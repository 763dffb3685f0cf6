// SPDX-License-Identifier: Apache-2.0
#pragma once
// Speech out of text, by eSpeak NG.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <hc/base/result.h>

/// How to speak.
struct Voice {
  std::string name = "en";  ///< as `espeak-ng --voices` lists languages, "+f3" behind for a variant
  int rate = 175;           ///< words a minute, 80 … 450
  int pitch = 50;           ///< 0 … 100
  int volume = 100;         ///< 0 … 200; above 100 the loud is cut off
};

/// A word, and when it is spoken [s since the beginning of the sound]. Of words that eSpeak NG
/// joins ("on the"), each gets a share of their time by its letters.
struct SpokenWord {
  double start = 0, end = 0;
  std::u32string word;
};

struct Speech {
  std::vector<std::int16_t> samples;  ///< one channel, of Synthesis::rate()
  std::vector<SpokenWord> words;
};

/// eSpeak NG. A process has one of it, whose state all objects share: they are for one thread.
class Synthesis {
 public:
  /// Errors: System (its data are not there).
  static hc::Result<Synthesis> start();

  /// Speaks a text that speakable() has made, whole. SSML and phonemes in it are text like any
  /// other. What is longer than 10 minutes is cut.
  ///
  /// Errors: NotFound (no such voice), System.
  /// Cost: about 4 ms for each second of sound.
  hc::Result<Speech> say(std::u32string_view text, const Voice& voice);

  /// Sample frames a second. [Hz]
  [[nodiscard]] int rate() const { return rate_; }

 private:
  explicit Synthesis(int rate) : rate_(rate) {}

  int rate_ = 0;
};
