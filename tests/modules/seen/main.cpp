// SPDX-License-Identifier: Apache-2.0
// Sends images of a camera with two people and a hand at known places, as the modules that find
// them do; says what it is told of them, and whom it holds.
#include <hc/base/format.h>
#include <hc/module/module.h>
#include <transports/all.h>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace {

constexpr int kWidth = 320, kHeight = 240;
constexpr int kFaceColumns = 24, kHandColumns = 46;
constexpr double kAnn = 7, kStranger = 8;  // tracks

std::vector<std::uint8_t> image_pixels() {
  std::vector<std::uint8_t> pixels;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const auto grey = static_cast<std::uint8_t>(60 + 100 * x / kWidth);
      pixels.insert(pixels.end(), {grey, grey, static_cast<std::uint8_t>(160 - 60 * y / kHeight)});
    }
  return pixels;
}

/// A row of a face whose box is a square [px].
std::array<double, kFaceColumns> face(double x, double y, double side, double track,
                                      double person) {
  std::array<double, kFaceColumns> row = {x, y, side, side, 0.9, track, person};
  // Eyes, nose, mouth and ears, as parts of the box.
  constexpr double kPoints[] = {0.3, 0.4, 0.7, 0.4, 0.5, 0.6, 0.5, 0.8, 0.05, 0.5, 0.95, 0.5};
  for (std::size_t i = 0; i < std::size(kPoints); ++i)
    row[7 + i] = (i % 2 == 0 ? x : y) + side * kPoints[i];
  row[21] = 2;  // before the head [m]
  return row;
}

/// A row of a right hand that is open, with its wrist at a place [px].
std::array<double, kHandColumns> open_hand(double x, double y) {
  constexpr int kFingers = 5, kJoints = 4;
  constexpr double kSign = 1, kTrack = 3;
  std::array<double, kHandColumns> row = {kTrack, 1, 0.9, kSign, x, y};
  for (int finger = 0; finger < kFingers; ++finger)
    for (int joint = 0; joint < kJoints; ++joint) {
      const auto at = static_cast<std::size_t>(6 + 2 * (kJoints * finger + joint));
      row[at] = x + (finger - 2) * (6.0 + 3 * joint);
      row[at + 1] = y - 20 - 8 * joint;
    }
  return row;
}

}  // namespace

int main(int argc, char** argv) {
  hc::add_all_transports();
  hc::Module module{"seen", "Sends people and a hand at known places."};
  auto left = module.output("left", hc::rgb_image().in(hc::Coord::kLeftImage), "a grey image");
  auto faces = module.output(
      "faces", hc::table(), "two faces",
      {.columns = {"x [px]", "y [px]", "width [px]", "height [px]", "score", "track", "person"}});
  auto names = module.output("names", hc::string(), "Ann is person 1");
  auto hands = module.output("hands", hc::table(), "a hand",
                             {.columns = {"track", "side", "presence", "sign"}});
  auto attended = module.output("attended", hc::table().of(1, 3), "whoever is held, else Ann",
                                {.columns = {"track", "person", "reason"}});
  auto place = module.output("target", hc::position().in(hc::Coord::kHead), "straight ahead");
  auto heard = module.output("heard", hc::string(), "what it is told");
  auto name = module.input("name", hc::string(), "\"TRACK NAME\"");
  auto hold = module.input("hold", hc::table().of(1, 1), "track to hold on to; 0: none");
  auto target = module.input("target", hc::position(), "selected point");
  auto show = module.parameter("show", true, "", "whether anybody is there");

  double held = 0;
  module.on(name, [&](const auto& message) {
    heard.send(hc::format("name {}", message.text()));
    module.log("nobody can be learned here");
  });
  module.on(hold, [&](const auto& message) {
    if (message.numbers()[0] != held)
      heard.send(hc::format("hold {}", static_cast<int>(message.numbers()[0])));
    held = message.numbers()[0];
  });
  module.on(target, [&](const auto&) { heard.send("target"); });
  const auto pixels = image_pixels();
  module.every(std::chrono::milliseconds(50), [&] {
    const auto now = module.now();
    left.send(hc::rgb_image().message(kHeight, kWidth, pixels), now, hc::Coord::kLeftImage);
    std::vector<double> rows;
    if (*show)
      for (const auto& row : {face(40, 60, 80, kAnn, 1), face(200, 80, 60, kStranger, 0)})
        rows.insert(rows.end(), row.begin(), row.end());
    const auto count = static_cast<std::int32_t>(rows.size()) / kFaceColumns;
    faces.send(hc::table().message(count, kFaceColumns, rows), now, hc::Coord::kLeftRectified);
    std::vector<double> hand;
    if (*show) {
      const auto row = open_hand(160, 220);
      hand.assign(row.begin(), row.end());
    }
    hands.send(hc::table().message(*show ? 1 : 0, kHandColumns, hand), now,
               hc::Coord::kLeftRectified);
    names.send("1 Ann", now);
    if (*show) place.send({2, 0, 0}, now);
    if (*show)
      attended.send({held != 0 ? held : kAnn, held == kStranger ? 0.0 : 1.0, held != 0 ? 2.0 : 0.0},
                    now);
  });
  return module.run(argc, argv);
}
