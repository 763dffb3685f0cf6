// SPDX-License-Identifier: Apache-2.0
// A mouth: plays sound and writes it to a file.
#include <hc/module/module.h>
#include <hc/os/program.h>

#include "player.h"

namespace {

constexpr std::chrono::milliseconds kLook{100};  // how often the device is checked

/// Sound of i16 and f32 in up to as many channels as can be played.
hc::AnyKind any_sound() {
  hc::AnyKind any;
  for (int channels = 1; channels <= hc::audio::kMostChannels; ++channels) {
    any.types.push_back(hc::sound<std::int16_t>(channels).type);
    any.types.push_back(hc::sound<float>(channels).type);
  }
  return any;
}

}  // namespace

int main(int argc, char** argv) {
  hc::Module module{"speaker", "Plays sound and writes it to a WAV file."};
  auto sound = module.input("sound", any_sound(), "of a rate, coord 20 … 24; f32 from -1 to 1");
  auto device = module.parameter("device", "", "",
                                 "SDL's name of the loudspeaker, \"\": the default, \"none\": none",
                                 {.fixed = true});
  auto save = module.parameter(
      "save", "", "",
      "WAV file to write, always a valid file; one of the same format is appended to",
      {.fixed = true});
  auto rate =
      module.parameter("rate", 0, "Hz", "of the device and the file, 0: that of the first sound",
                       {.min = 0, .max = 192000, .fixed = true});
  auto channels =
      module.parameter("channels", 0, "", "the same", {.min = 0, .max = 8, .fixed = true});
  auto buffer =
      module.parameter("buffer", 1.0, "s", "sound that may wait to be played before more is taken",
                       {.min = 0, .max = 60, .fixed = true});

  std::optional<Player> player;
  auto or_end = [](const hc::Status& status) {
    if (!status) throw hc::ModuleError(status.error());
  };
  module.on_start([&] {
    player.emplace(
        PlayerOptions{*device != "none", *device, *save, static_cast<int>(*rate),
                      static_cast<int>(*channels), *buffer},
        [&](std::string_view line) { module.log(line); }, hc::stop_descriptor());
  });
  module.on(sound, [&](const hc::Message& message) {
    const auto known = hc::audio::rate_of(message.header.coord);
    if (!known)
      return module.log_once("no rate", "sound dropped: coordinate system " +
                                            hc::coord_text(message.header.coord) +
                                            " has no sample rate");
    const hc::audio::Format format{*known, message.header.info.components};
    if (message.header.info.scalar == hc::Scalar::F32)
      or_end(player->play(hc::value_or_end(message.view<float>()).numbers(), format));
    else
      or_end(player->play(hc::value_or_end(message.view<std::int16_t>()).numbers(), format));
  });
  module.every(kLook, [&] { player->look(); });
  module.on_end([&] { or_end(player->finish()); });
  const int status = module.run(argc, argv);
  if (player && player->dropped() > 0)
    module.log(std::to_string(player->dropped()) + " messages were dropped without a loudspeaker");
  return status;
}
