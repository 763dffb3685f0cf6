// SPDX-License-Identifier: Apache-2.0
// Ears: sound from a microphone or a WAV file.
#include <algorithm>

#include <hc/module/module.h>
#include <hc/os/program.h>

#include "ears.h"

namespace {

constexpr int kPiecesPerSecond = 50;             // of 20 ms
constexpr std::chrono::milliseconds kLook{100};  // how long commands may go unnoticed
constexpr std::int64_t kSecond = 1'000'000'000;  // [ns]

template <typename Output>
void send(Output& output, const Piece& piece, std::int32_t channels, std::int32_t coord) {
  auto draft = output.loan(static_cast<std::int32_t>(piece.samples.size()) / channels, 1);
  draft.header.time = piece.time;
  draft.header.coord = coord;
  std::copy(piece.samples.begin(), piece.samples.end(), draft.matrix().numbers().begin());
  output.send(std::move(draft));
}

}  // namespace

int main(int argc, char** argv) {
  hc::Module module{"microphone", "Gives the sound of a microphone or a WAV file."};
  auto mono = module.output("mono", hc::sound<std::int16_t>(1),
                            "pieces of 20 ms, where channels is 1; coord 20 … 24 by the rate");
  auto stereo = module.output("stereo", hc::sound<std::int16_t>(2),
                              "the same, left and right, where channels is 2");
  auto file = module.parameter("file", "", "", "a WAV file instead of a microphone",
                               {.positional = true, .fixed = true});
  auto device = module.parameter(
      "device", "", "", "SDL's name of the microphone, \"\": the default", {.fixed = true});
  auto rate = module.parameter("rate", 16000, "Hz", "8000, 16000, 22050, 44100 or 48000",
                               {.min = 8000, .max = 48000, .fixed = true});
  auto channels =
      module.parameter("channels", 1, "", "1 or 2", {.min = 1, .max = 2, .fixed = true});
  auto paced =
      module.parameter("paced", true, "", "a file in real time; false: as fast as it is taken");

  std::optional<FileEar> from_file;
  std::optional<DeviceEar> from_device;
  std::int32_t coord = 0;
  std::int64_t start = 0, given = 0;

  module.on_start([&] {
    const hc::audio::Format format{static_cast<int>(*rate), static_cast<int>(*channels)};
    auto known = hc::audio::coord_of(format.rate);
    if (!known)
      throw hc::ModuleError(
          hc::Error{hc::Code::Invalid, "parameter rate: " + std::to_string(*rate) +
                                           " is not 8000, 16000, 22050, 44100 or 48000"});
    coord = *known;
    start = module.now();
    if (!file->empty())
      from_file.emplace(hc::value_or_end(FileEar::open(*file, format)));
    else
      from_device.emplace(*device, format, format.rate / kPiecesPerSecond,
                          [&](std::string_view line) { module.log(line); });
  });
  auto send_piece = [&](const Piece& piece) {
    if (*channels == 1)
      send(mono, piece, 1, coord);
    else
      send(stereo, piece, 2, coord);
  };
  module.generate([&] {
    if (from_device) {
      if (auto piece = from_device->next(kLook, hc::stop_descriptor())) send_piece(*piece);
      return true;
    }
    // At the end of a piece it has been heard, as by a microphone.
    if (*paced) module.keep_rate(kPiecesPerSecond);
    Piece piece;
    piece.samples =
        hc::value_or_end(from_file->next(static_cast<std::size_t>(*rate / kPiecesPerSecond)));
    if (piece.samples.empty()) return false;
    piece.time = start + given / *rate * kSecond + given % *rate * kSecond / *rate;
    given += static_cast<std::int64_t>(piece.samples.size()) / *channels;
    send_piece(piece);
    return true;
  });
  return module.run(argc, argv);
}
