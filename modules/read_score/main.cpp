// SPDX-License-Identifier: Apache-2.0
// How well a robot reads aloud what is written before it.
#include <string>

#include <hc/base/format.h>
#include <hc/module/module.h>

#include "read_score.h"

namespace {

constexpr double kSoundRate = 22050;             // of coordinate system 22 [Hz]
constexpr double kLook = 100;                    // [Hz]
constexpr std::int64_t kSettle = 1'000'000'000;  // from the first text until the first test [ns]

std::int64_t nanoseconds(double seconds) {
  return static_cast<std::int64_t>(seconds * 1e9);
}

}  // namespace

int main(int argc, char** argv) {
  hc::Module module{"read_score", "Writes texts for a robot to read aloud, and scores it."};
  auto text = module.input("text", hc::string().in(hc::Coord::kText),
                           "what was read, with the image's time");
  auto sound = module.input("sound", hc::sound<std::int16_t>(1).in(hc::Coord::kSound22k),
                            "what is spoken, with the time of the text");
  auto writing =
      module.output("writing", hc::string().in(hc::Coord::kText), "the next text for the board");
  auto result =
      module.output("score", hc::table<double>().of(6, 1),
                    "character error rate; seen to spoken, median and maximum [s]; of "
                    "it since the image that decided, median [s]; texts; texts not spoken");
  auto seed =
      module.parameter("seed", 1, "", "of the texts", {.min = 0, .max = 1e9, .fixed = true});
  auto count = module.parameter("count", 5, "", "texts", {.min = 1, .max = 100'000});
  auto time_out =
      module.parameter("time_out", 10.0, "s", "maximum time for a text", {.min = 0.1, .max = 1000});
  auto pause = module.parameter("pause", 0.3, "s", "from the end of the speech to the next text",
                                {.min = 0, .max = 1000});

  std::mt19937_64 random;
  std::vector<ReadText> texts;
  std::optional<Attempt> attempt;
  std::int64_t next_at = 0;      // the next text, or the first one at the latest [ns]
  std::int64_t heard_until = 0;  // what is spoken [ns]
  bool has_begun = false;

  module.on_start([&] {
    random.seed(static_cast<std::uint64_t>(*seed));
    next_at = module.now() + nanoseconds(*time_out);
  });
  module.on(text, [&](const auto& message) {
    // The first text shows that all is running; the head turns to it.
    if (!has_begun) next_at = module.now() + kSettle;
    has_begun = true;
    if (attempt) attempt->take_text(std::string(message.characters()), message.header.time);
  });
  module.on(sound, [&](const auto& message) {
    const std::int64_t now = module.now();
    heard_until = now + nanoseconds(message.header.width / kSoundRate);
    if (attempt) attempt->take_sound(message.header.time, now);
  });

  auto finish = [&] {
    const auto score = score_of(texts);
    result.send(hc::table({score.error_rate, score.median, score.most, score.work,
                           static_cast<double>(score.texts), static_cast<double>(score.unspoken)}));
    auto line = hc::format(
        "character error rate {:.1f} %, seen to spoken {:.2f} s median, {:.2f} s at most, of {} "
        "texts",
        100 * score.error_rate, score.median, score.most, score.texts);
    if (score.unspoken > 0) line += hc::format("; {} not spoken in time", score.unspoken);
    module.log("result: " + line);
  };
  module.generate([&] {
    module.keep_rate(kLook);
    const std::int64_t now = module.now();
    if (attempt) {
      if (!attempt->is_done() && now - attempt->written_at() < nanoseconds(*time_out)) return true;
      texts.push_back(attempt->result());
      attempt.reset();
      const auto& last = texts.back();
      if (last.read != last.truth)
        module.log("\"" + last.truth + "\" was read as \"" + last.read + "\"");
      next_at = std::max(now, heard_until) + nanoseconds(*pause);
    }
    if (static_cast<std::int64_t>(texts.size()) >= *count) {
      finish();
      return false;
    }
    if (now < std::max(next_at, heard_until)) return true;
    has_begun = true;
    attempt.emplace(random_text(random), now);
    writing.send(hc::string(attempt->truth()).at(now));
    return true;
  });
  return module.run(argc, argv);
}
