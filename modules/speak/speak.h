// SPDX-License-Identifier: Apache-2.0
#pragma once
// Speaks text. Unlike the other programs, this one links eSpeak NG, which is under the GPL 3.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include <hc/module/module.h>

#include "synthesis.h"
#include "words.h"

struct SpeakParameters {
  hc::Module& module;

  hc::Parameter<std::string> voice =
      module.parameter("voice", "en", "", "language or voice, from espeak-ng --voices");
  hc::Parameter<std::int64_t> rate =
      module.parameter("rate", 175, "1/min", "words a minute", {.min = 80, .max = 450});
  hc::Parameter<std::int64_t> pitch =
      module.parameter("pitch", 50, "", "of the voice", {.min = 0, .max = 100});
  hc::Parameter<std::int64_t> volume =
      module.parameter("volume", 100, "", "of the voice", {.min = 0, .max = 200});
  hc::Parameter<bool> paced = module.parameter(
      "paced", true, "", "a text begins when the one before has been played; false: at once");
  hc::Parameter<std::int64_t> waiting =
      module.parameter("waiting", 4, "", "length of the queue; the oldest texts are dropped",
                       {.min = 1, .max = 1000});

  [[nodiscard]] Voice settings() const {
    return {*voice, static_cast<int>(*rate), static_cast<int>(*pitch), static_cast<int>(*volume)};
  }
};

class Speak {
 public:
  /// @param module  must outlive it.
  explicit Speak(hc::Module& module);

  /// For the end of the program.
  void log_result() const;

 private:
  void start();
  void take(const hc::MessageOf<hc::StringKind>& message);
  void speak_due();
  void speak(const WaitingText& next);
  void send(const Speech& speech, const WaitingText& text);

  hc::Module& module_;
  hc::Input<hc::StringKind> text_ = module_.input(
      "text", hc::string(), "text to speak; UTF-8, cut after 2000 characters", {.keep = 16});
  hc::Output<hc::SoundKind<std::int16_t>> sound_ =
      module_.output("sound", hc::sound(1).in(hc::Coord::kSound22k), "a message for each text");
  hc::Output<hc::StringKind> words_ =
      module_.output("words", hc::string().in(hc::Coord::kText),
                     "a message for each text, with the sound's time, and in it a row for "
                     "each word: START END WORD [s since the sound begins]; words that "
                     "eSpeak NG joins share their time by their letters");
  const SpeakParameters parameters_{module_};

  std::optional<Synthesis> synthesis_;
  TextQueue queue_;
  hc::MonotonicTime spoken_until_{0};
  std::int64_t dropped_ = 0;
  std::string problem_;  // last logged
  std::size_t said_ = 0;
  std::string last_;
};
