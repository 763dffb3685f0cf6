// SPDX-License-Identifier: Apache-2.0
// Sends sound from a microphone or a WAV file.
#include <hc/module/module.h>
#include <transports/all.h>

#include "ears.h"

int main(int argc, char** argv) {
  hc::add_all_transports();
  hc::Module module{"microphone", "Sends the sound of a microphone or a WAV file."};
  auto mono = module.output("mono", hc::sound(1),
                            "pieces of 20 ms, where channels is 1; coord 20 … 24 by the rate");
  auto stereo =
      module.output("stereo", hc::sound(2), "the same, left and right, where channels is 2");
  auto file = module.parameter("file", "", "", "WAV file instead of a microphone",
                               {.positional = true, .fixed = true});
  auto device = module.parameter(
      "device", "", "", "SDL's name of the microphone, \"\": the default", {.fixed = true});
  auto rate = module.parameter("rate", 16000, "Hz", "8000, 16000, 22050, 44100 or 48000",
                               {.min = 8000, .max = 48000, .fixed = true});
  auto channels =
      module.parameter("channels", 1, "", "1 or 2", {.min = 1, .max = 2, .fixed = true});
  auto paced =
      module.parameter("paced", true, "", "a file in real time; false: as fast as it is read");

  std::optional<FileEar> from_file;
  std::optional<DeviceEar> from_device;

  auto send = [&](const Piece& piece) { (*channels == 1 ? mono : stereo).send(piece); };
  auto send_from_file = [&] {
    // A piece is sent at its end, as by a microphone.
    if (*paced) module.keep_rate(kPiecesPerSecond);
    const auto piece = hc::value_or_end(from_file->next());
    if (!piece) return module.stop();
    send(*piece);
  };
  module.on_start([&] {
    const hc::audio::Format format{static_cast<int>(*rate), static_cast<int>(*channels)};
    if (!hc::audio::coord_of(format.rate))
      hc::refuse(rate, std::to_string(*rate) + " is not 8000, 16000, 22050, 44100 or 48000");
    if (!file->empty()) {
      from_file.emplace(hc::value_or_refuse(file, FileEar::open(*file, format, module.now())));
      return module.generate(send_from_file);
    }
    from_device.emplace(*device, format,
                        [&](hc::Level level, std::string_view line) { module.log(line, level); });
    from_device->look();
  });
  module.on_readable([&] { return from_device ? from_device->descriptor() : -1; },
                     [&] {
                       while (auto piece = from_device->next()) send(*piece);
                     });
  module.every(DeviceEar::kLook, [&] {
    if (from_device) from_device->look();
  });
  return module.run(argc, argv);
}
