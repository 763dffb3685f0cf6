// SPDX-License-Identifier: Apache-2.0
// Measures the level and direction of sound.
#include <utility>

#include <hc/base/format.h>
#include <hc/module/module.h>
#include <sound/direction.h>
#include <sound/format.h>
#include <transports/all.h>

int main(int argc, char** argv) {
  hc::add_all_transports();
  hc::Module module{"hearing", "Measures the level and the direction of stereo sound."};
  auto sound = module.input("sound", hc::sound(2), "left and right ear", {.keep = 64});
  auto level = module.output("level", hc::table(),
                             "root of the mean square of each message, 1 is full scale",
                             {.columns = {"level"}});
  auto direction = module.output("direction", hc::rotation().in(hc::Coord::kHead),
                                 "roll 0, tilt 0, pan [rad], > 0 to the left; nothing while it is "
                                 "too quiet or comes from several sides");
  auto base =
      module.parameter("base", 0.18, "m", "distance between the ears", {.min = 0.01, .max = 1});
  auto min_level = module.parameter("min_level", 0.005, "", "minimum level for a direction",
                                    {.min = 0, .max = 1});

  bool has_assumed = false;
  module.on(sound, [&](const auto& message) {
    const auto rate = hc::audio::rate_of(message.header.coord);
    if (!rate)
      return module.log_once("without a rate", "sound dropped: its coord is no sample rate");
    if (!base.is_set() && !std::exchange(has_assumed, true))
      module.log(
          hc::format("assumed: ears {} m apart, as on the default head; directions may be "
                     "wrong: set base",
                     *base));
    const auto heard = hc::audio::hear(message.numbers(), *rate, *base);
    level.send(heard.level);
    if (heard.pan && heard.level >= *min_level)
      direction.send({0.0, 0.0, *heard.pan}, hc::Time(), hc::Coord::kHead);
  });
  return module.run(argc, argv);
}
