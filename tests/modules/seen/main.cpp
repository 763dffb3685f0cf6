// SPDX-License-Identifier: Apache-2.0
// Sends images of a camera with two people and a hand at known places, as the modules that find
// them do; says what it is told of them, and whom it holds.
#include <hc/base/format.h>
#include <hc/module/module.h>
#include <people/face_table.h>
#include <people/hand_table.h>
#include <transports/all.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace {

constexpr int kWidth = 320, kHeight = 240;
constexpr int kAnn = 7, kStranger = 8;  // tracks

std::vector<std::uint8_t> image_pixels() {
  std::vector<std::uint8_t> pixels;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const auto grey = static_cast<std::uint8_t>(60 + 100 * x / kWidth);
      pixels.insert(pixels.end(), {grey, grey, static_cast<std::uint8_t>(160 - 60 * y / kHeight)});
    }
  return pixels;
}

/// A face whose box is a square [px].
hc::people::FaceRow face(float x, float y, float side, int track, int person) {
  hc::people::FaceRow row{{{x, y, side, side}, 0.9F, {}}, track, person, {2, 0, 0}};
  // Eyes, nose, mouth and ears, as parts of the box.
  constexpr float kPoints[][2] = {{0.3F, 0.4F}, {0.7F, 0.4F},  {0.5F, 0.6F},
                                  {0.5F, 0.8F}, {0.05F, 0.5F}, {0.95F, 0.5F}};
  for (std::size_t i = 0; i < std::size(kPoints); ++i)
    row.face.points[i] = {x + side * kPoints[i][0], y + side * kPoints[i][1]};
  return row;
}

/// A right hand that is open, with its wrist at a place [px].
hc::people::HandRow open_hand(float x, float y) {
  constexpr int kFingers = 5, kJoints = 4, kTrack = 3;
  hc::people::HandRow row{kTrack, hc::people::Hand::Side::Right, 0.9F, hc::people::Sign::Open, {}};
  row.points[0] = {x, y};
  for (int finger = 0; finger < kFingers; ++finger)
    for (int joint = 0; joint < kJoints; ++joint)
      row.points[static_cast<std::size_t>(1 + kJoints * finger + joint)] = {
          x + static_cast<float>((finger - 2) * (6 + 3 * joint)),
          y - 20 - 8 * static_cast<float>(joint)};
  return row;
}

/// A table of such rows.
template <typename Row>
std::vector<double> table_of(const std::vector<Row>& rows, std::int32_t columns) {
  const auto width = static_cast<std::size_t>(columns);
  std::vector<double> numbers(rows.size() * width);
  for (std::size_t i = 0; i < rows.size(); ++i)
    write(rows[i], std::span(numbers).subspan(i * width, width));
  return numbers;
}

}  // namespace

int main(int argc, char** argv) {
  hc::add_all_transports();
  hc::Module module{"seen", "Sends people and a hand at known places."};
  auto left = module.output("left", hc::rgb_image().in(hc::Coord::kLeftImage), "a grey image");
  auto faces =
      module.output("faces", hc::table(), "two faces", {.columns = hc::people::face_columns()});
  auto names = module.output("names", hc::string(), "Ann is person 1");
  auto hands =
      module.output("hands", hc::table(), "a hand", {.columns = hc::people::hand_columns()});
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
    std::vector<hc::people::FaceRow> seen;
    std::vector<hc::people::HandRow> shown;
    if (*show) {
      seen = {face(40, 60, 80, kAnn, 1), face(200, 80, 60, kStranger, 0)};
      shown = {open_hand(160, 220)};
    }
    using hc::people::kFaceColumns, hc::people::kHandColumns;
    const auto count = [](const auto& rows) { return static_cast<std::int32_t>(rows.size()); };
    faces.send(hc::table().message(count(seen), kFaceColumns, table_of(seen, kFaceColumns)), now,
               hc::Coord::kLeftRectified);
    hands.send(hc::table().message(count(shown), kHandColumns, table_of(shown, kHandColumns)), now,
               hc::Coord::kLeftRectified);
    names.send("1 Ann", now);
    if (*show) place.send({2, 0, 0}, now);
    if (*show)
      attended.send(
          {held != 0 ? held : double(kAnn), held == kStranger ? 0.0 : 1.0, held != 0 ? 2.0 : 0.0},
          now);
  });
  return module.run(argc, argv);
}
