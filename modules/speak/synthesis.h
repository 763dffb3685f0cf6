// SPDX-License-Identifier: Apache-2.0
#pragma once
// Speech synthesis with eSpeak NG.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <hc/base/result.h>

struct Voice {
  std::string name = "en";  ///< as listed by `espeak-ng --voices`; with "+f3" for a variant
  int rate = 175;           ///< words a minute, 80 … 450
  int pitch = 50;           ///< 0 … 100
  int volume = 100;         ///< 0 … 200; may clip above 100
};

/// A word and its time [s since the start of the sound]. Words that eSpeak NG joins ("on the")
/// share their time in proportion to their letters.
struct SpokenWord {
  double start = 0, end = 0;
  std::u32string word;
};

struct Speech {
  std::vector<std::int16_t> samples;  ///< mono, at Synthesis::rate()
  std::vector<SpokenWord> words;
};

/// eSpeak NG. Its state is global: all objects share it, and must be used on one thread.
class Synthesis {
 public:
  /// Errors: System (its data is not installed).
  static hc::Result<Synthesis> start();

  /// Synthesises a text from speakable(). SSML and phonemes in it are read as plain text. Cuts the
  /// sound after 10 minutes.
  ///
  /// Errors: NotFound (no such voice), System.
  /// Cost: about 4 ms per second of sound.
  hc::Result<Speech> say(std::u32string_view text, const Voice& voice);

  /// Sample rate [Hz].
  [[nodiscard]] int rate() const { return rate_; }

 private:
  explicit Synthesis(int rate) : rate_(rate) {}

  int rate_ = 0;
};
