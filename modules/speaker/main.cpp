// SPDX-License-Identifier: Apache-2.0
// Plays sound and writes it to a file.
#include <client/running.h>
#include <hc/module/module.h>
#include <hc/os/program.h>
#include <sound/messages.h>
#include <transports/all.h>

#include "player.h"

int main(int argc, char** argv) {
  hc::add_all_transports();
  hc::Module module{"speaker", "Plays sound and writes it to a WAV file."};
  auto sound =
      module.input("sound", hc::audio::any_sound(), "of a rate, coord 20 … 24; f32 from -1 to 1");
  auto device = module.parameter("device", "", "",
                                 R"(SDL's name of the loudspeaker, "": the default, "none": none)",
                                 {.fixed = true});
  auto save = module.parameter(
      "save", "", "",
      "WAV file to write, valid at any time; an existing x.wav is kept, and x_2.wav is written",
      {.fixed = true});
  auto rate =
      module.parameter("rate", 0, "Hz", "of the device and the file, 0: that of the first sound",
                       {.min = 0, .max = 192000, .fixed = true});
  auto channels =
      module.parameter("channels", 0, "", "the same", {.min = 0, .max = 8, .fixed = true});
  auto buffer =
      module.parameter("buffer", 1.0, "s", "sound queued for playing before the input blocks",
                       {.min = 0, .max = 60, .fixed = true});

  std::optional<Player> player;
  module.on_start([&] {
    player.emplace(
        PlayerOptions{*device != "none", *device, *save, static_cast<int>(*rate),
                      static_cast<int>(*channels), *buffer},
        [&](hc::Level level, std::string_view line) { module.log(line, level); },
        hc::stop_descriptor());
  });
  module.on(sound, [&](const hc::Message& message) {
    const auto format = hc::audio::format_of(message);
    if (!format) return module.log_once("no rate", "sound dropped: " + format.error().detail);
    hc::succeed_or_end(player->play(message, *format));
  });
  module.every(Player::kLook, [&] { player->look(); });
  module.on_end([&] { hc::succeed_or_end(player->finish()); });
  const int status = module.run(argc, argv);
  if (player && player->dropped() > 0)
    module.log(std::to_string(player->dropped()) + " messages were dropped without a loudspeaker");
  const bool has_failed = player && player->has_file_error() && !hc::own_graph();
  return status == 0 && has_failed ? 1 : status;
}
