// SPDX-License-Identifier: Apache-2.0
// Writes texts on a board for a robot to read aloud, and scores the result.
#include <hc/module/module.h>
#include <sound/format.h>
#include <transports/all.h>

#include "read_score.h"

int main(int argc, char** argv) {
  hc::add_all_transports();
  hc::Module module{"read_score", "Writes texts for a robot to read aloud, and scores it."};
  auto text =
      module.input("text", hc::string().in(hc::Coord::kText), "text read, with the image's time");
  auto sound = module.input("sound", hc::sound(1).in(hc::Coord::kSound22k),
                            "speech, with the time of the text");
  auto writing =
      module.output("writing", hc::string().in(hc::Coord::kText), "the next text for the board");
  auto result = module.output("score", hc::table().of(1, 6),
                              "character error rate; seen to spoken, median and maximum [s]; of "
                              "it after the decisive image, median [s]; texts; texts not spoken");
  auto seed =
      module.parameter("seed", 1, "", "of the texts", {.min = 0, .max = 1e9, .fixed = true});
  auto count = module.parameter("count", 5, "", "texts", {.min = 1, .max = 100'000});
  auto time_out =
      module.parameter("time_out", 10.0, "s", "maximum time for a text", {.min = 0.1, .max = 1000});
  auto pause = module.parameter("pause", 0.3, "s", "from the end of the speech to the next text",
                                {.min = 0, .max = 1000});

  std::optional<Dictation> dictation;
  module.on_start([&] {
    dictation.emplace(static_cast<std::uint64_t>(*seed), module.now() + hc::duration(*time_out));
  });
  module.on(text, [&](const auto& message) {
    dictation->take_text(std::string(message.text()), message.header.time, module.now());
  });
  module.on(sound, [&](const auto& message) {
    const double rate = *hc::audio::rate_of(message.header.coord);  // [Hz]
    dictation->take_sound(message.header.time, module.now(), message.header.width / rate);
  });
  module.every(std::chrono::milliseconds(10), [&] {
    const hc::Time now = module.now();
    const auto ended = dictation->finish(now, *time_out, *pause);
    if (ended && ended->read != ended->truth)
      module.log("\"" + ended->truth + "\" was read as \"" + ended->read + "\"");
    if (!dictation->is_done(*count)) {
      if (const auto next = dictation->write(now)) writing.send(*next, now);
      return;
    }
    const auto score = dictation->score();
    result.send(score.numbers());
    module.log(score.text(), hc::Level::Result);
    module.stop();
  });
  return module.run(argc, argv);
}
