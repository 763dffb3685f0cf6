// SPDX-License-Identifier: Apache-2.0
// Sends one stream of each sort, whose contents are known, so that a test can compare what is shown
// of them; and hears words.
#include <hc/module/module.h>
#include <transports/all.h>

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

namespace {

using Colour = std::array<std::uint8_t, 3>;

constexpr int kWidth = 160, kHeight = 120;
/// Of the quarters of the image, from the upper left one on, row by row.
constexpr std::array<Colour, 4> kColours = {Colour{200, 40, 30}, Colour{30, 160, 60},
                                            Colour{20, 60, 200}, Colour{128, 128, 128}};

std::vector<std::uint8_t> image_pixels() {
  std::vector<std::uint8_t> pixels;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const auto quarter = (y < kHeight / 2 ? 0U : 2U) + (x < kWidth / 2 ? 0U : 1U);
      pixels.insert(pixels.end(), kColours[quarter].begin(), kColours[quarter].end());
    }
  return pixels;
}

/// [m], row by row: near on the left, far on the right, unknown in the lowest quarter.
std::vector<float> depth_values() {
  constexpr float kNear = 1.5F, kFar = 3.5F, kUnknown = 0;
  std::vector<float> values;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x)
      values.push_back(4 * y >= 3 * kHeight ? kUnknown : x < kWidth / 2 ? kNear : kFar);
  return values;
}

/// 50 ms of a square wave of 500 Hz: at half of the full scale, and at a quarter.
std::vector<std::int16_t> samples() {
  constexpr int kCount = 800, kHalfPeriod = 16;
  constexpr std::int16_t kLeft = 16384, kRight = 8192;
  std::vector<std::int16_t> wave;
  for (int i = 0; i < kCount; ++i) {
    const int sign = i / kHalfPeriod % 2 == 0 ? 1 : -1;
    wave.push_back(static_cast<std::int16_t>(sign * kLeft));
    wave.push_back(static_cast<std::int16_t>(sign * kRight));
  }
  return wave;
}

}  // namespace

int main(int argc, char** argv) {
  hc::add_all_transports();
  hc::Module module{"known", "Sends streams whose contents are known."};
  auto image = module.output("image", hc::rgb_image(), "four colours");
  auto depth = module.output("depth", hc::intensity_image<float>().in(hc::Coord::kDepth),
                             "1.5 m, 3.5 m and unknown");
  auto number = module.output("number", hc::table(), "42.5", {.columns = {"level [m]"}});
  auto grid = module.output("grid", hc::table(), "1 to 6 in two rows");
  auto text = module.output("text", hc::string(), "a sentence");
  auto sound = module.output("sound", hc::sound(2).in(hc::Coord::kSound16k),
                             "a square wave of -6 dB and -12 dB");
  auto words = module.input("words", hc::string(), "any words");
  auto heard = module.output("heard", hc::string(), "the same");

  module.on(words, [&](const auto& message) { heard.send(message); });
  const auto pixels = image_pixels();
  const auto metres = depth_values();
  const auto wave = samples();
  module.every(std::chrono::milliseconds(50), [&] {
    const auto now = module.now();
    image.send(hc::rgb_image().message(kHeight, kWidth, pixels), now, hc::Coord::kLeftImage);
    depth.send(hc::intensity_image<float>().message(kHeight, kWidth, metres), now,
               hc::Coord::kDepth);
    number.send(42.5, now);
    constexpr std::array<double, 6> kGrid = {1, 2, 3, 4, 5, 6};
    grid.send(hc::table().message(2, 3, kGrid), now);
    text.send("red green blue grey", now);
    sound.send(wave, now);
  });
  return module.run(argc, argv);
}
