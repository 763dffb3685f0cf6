// SPDX-License-Identifier: Apache-2.0
// Speaks text. Unlike the other programs, this one links eSpeak NG, which is under the GPL 3.
#include <optional>

#include <hc/base/format.h>
#include <hc/module/module.h>
#include <hc/mtp/rows.h>
#include <transports/all.h>

#include "synthesis.h"
#include "words.h"

namespace {

constexpr int kRate = 22050;                    // of eSpeak NG's voices [Hz]
constexpr std::chrono::milliseconds kLook{20};  // maximum gap between texts

}  // namespace

int main(int argc, char** argv) {
  hc::add_all_transports();
  hc::Module module{"speak", "Speaks text aloud, by eSpeak NG."};
  auto text = module.input("text", hc::string(), "text to speak; UTF-8, cut after 2000 characters", {.keep = 16});
  auto sound = module.output("sound", hc::sound(1).in(hc::Coord::kSound22k),
                             "a message for each text");
  auto words = module.output("words", hc::string().in(hc::Coord::kText),
                             "a message for each text, with the sound's time, and in it a row for "
                             "each word: START END WORD [s since the sound begins]; words that "
                             "eSpeak NG joins share their time by their letters");
  auto voice = module.parameter("voice", "en", "", "language or voice, from espeak-ng --voices");
  auto rate = module.parameter("rate", 175, "1/min", "words a minute", {.min = 80, .max = 450});
  auto pitch = module.parameter("pitch", 50, "", "of the voice", {.min = 0, .max = 100});
  auto volume = module.parameter("volume", 100, "", "of the voice", {.min = 0, .max = 200});
  auto paced = module.parameter(
      "paced", true, "", "a text begins when the one before has been played; false: at once");
  auto waiting =
      module.parameter("waiting", 4, "", "length of the queue; the oldest texts are dropped",
                       {.min = 1, .max = 1000});

  std::optional<Synthesis> synthesis;
  TextQueue queue;
  hc::MonotonicTime spoken_until{0};
  std::int64_t dropped = 0;
  std::string problem;  // last logged

  module.on_start([&] {
    synthesis.emplace(hc::value_or_end(Synthesis::start()));
    if (synthesis->rate() != kRate)
      throw hc::ModuleError(hc::format("eSpeak NG gives {} Hz, not {}", synthesis->rate(), kRate));
  });
  std::size_t said = 0;
  std::string last;
  auto speak = [&](const WaitingText& next) {
    auto speech = synthesis->say(
        next.characters,
        {*voice, static_cast<int>(*rate), static_cast<int>(*pitch), static_cast<int>(*volume)});
    if (!speech) {
      if (problem != speech.error().detail) module.log(problem = speech.error().detail);
      return;
    }
    problem.clear();
    const auto time = next.time != 0 ? next.time : module.now();
    const auto frames = speech->samples.size();
    auto draft = sound.loan(1, static_cast<std::int32_t>(frames));
    draft.header.time = time;
    draft.header.mode = next.mode;
    std::copy(speech->samples.begin(), speech->samples.end(), draft.matrix().numbers().begin());
    std::vector<std::string> rows;
    for (const auto& word : speech->words)
      rows.push_back(hc::format("{:.3f} {:.3f} {}", word.start, word.end, utf8(word.word)));
    auto table = hc::make_rows(rows);
    table.header.time = time;
    table.header.mode = next.mode;
    spoken_until = module.monotonic() + std::chrono::nanoseconds(static_cast<std::int64_t>(frames) *
                                                                 1'000'000'000 / kRate);
    ++said;
    last = utf8(next.characters);
    words.send({std::move(table)});  // first, since sending the sound may block while it plays
    sound.send(std::move(draft));
  };
  auto speak_next = [&] {
    while (!queue.empty() && (!*paced || module.monotonic() >= spoken_until)) speak(queue.pop());
  };
  module.on(text, [&](const auto& message) {
    std::string lines;
    for (const auto& row : hc::rows_of(message)) lines += row + " ";
    auto characters = speakable(lines);
    if (is_blank(characters)) return;
    if (queue.push({std::move(characters), message.header.time, message.header.mode},
                   static_cast<std::size_t>(*waiting)) &&
        dropped++ == 0)
      module.log("queue full: the oldest texts are dropped");
    speak_next();
  });
  module.every(kLook, speak_next);
  module.on_end([&] {
    while (!queue.empty()) speak(queue.pop());
  });
  const int status = module.run(argc, argv);
  if (said > 0)
    module.log(hc::format("said {} text{}, the last \"{}\"", said, said == 1 ? "" : "s", last),
               hc::Level::Result);
  if (dropped > 0) module.log(hc::format("{} texts dropped", dropped));
  return status;
}
