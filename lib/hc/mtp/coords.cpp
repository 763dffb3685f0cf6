// SPDX-License-Identifier: Apache-2.0
#include <hc/mtp/coords.h>

#include <algorithm>

namespace hc {
namespace {

constexpr const char* kMetres = "metres";
constexpr const char* kPixels = "pixels";

// Source: spec/mtp-1.md, R44
constexpr Coord kCoords[] = {
    {Coord::kWorld, "world", kMetres, true},
    {Coord::kRobot, "robot", "metres; the base on which the head stands", true},
    {Coord::kHead, "head", "metres; moves with pan and tilt", true},
    {Coord::kLeftEye, "left_eye", "metres; optical frame of the camera", true},
    {Coord::kRightEye, "right_eye", "metres; optical frame of the camera", true},
    {Coord::kCyclopeanEye, "cyclopean_eye", "metres; midway between the eyes", true},
    {Coord::kLeftImage, "left_image", kPixels},
    {Coord::kRightImage, "right_image", kPixels},
    {Coord::kLeftRectified, "left_rectified", kPixels},
    {Coord::kRightRectified, "right_rectified", kPixels},
    {Coord::kDepth, "depth", "pixel grid of left_rectified; metres along the optical axis"},
    {Coord::kDisparity, "disparity", "pixel grid of left_rectified; pixels"},
    {Coord::kGaze, "gaze", "radians: roll, tilt, pan of the pan-tilt unit"},
    {Coord::kSupervisor, "supervisor", "the person's head: metres, radians", true},
    {Coord::kRightDepth, "right_depth",
     "pixel grid of right_rectified; metres along the optical axis"},
    {Coord::kSound8k, "sound_8k", "sample frames at 8000 Hz"},
    {Coord::kSound16k, "sound_16k", "sample frames at 16000 Hz"},
    {Coord::kSound22k, "sound_22k", "sample frames at 22050 Hz"},
    {Coord::kSound44k, "sound_44k", "sample frames at 44100 Hz"},
    {Coord::kSound48k, "sound_48k", "sample frames at 48000 Hz"},
    {Coord::kText, "text", "characters in reading order"},
    {Coord::kOrder, "order", "plain index"},
};

template <typename Matches>
const Coord* find(Matches matches) {
  const auto* found = std::find_if(std::begin(kCoords), std::end(kCoords), matches);
  return found == std::end(kCoords) ? nullptr : found;
}

}  // namespace

std::span<const Coord> coords() {
  return kCoords;
}

const Coord* find_coord(std::int32_t number) {
  return find([&](const Coord& each) { return each.number == number; });
}

const Coord* find_coord(std::string_view name) {
  return find([&](const Coord& each) { return each.name == name; });
}

std::string coord_text(std::int32_t coord) {
  if (coord >= 1000 && coord < 1'000'000)
    return coord_text(coord / 1000) + " from " + coord_text(coord % 1000);
  const Coord* known = find_coord(coord);
  return known != nullptr ? std::string(known->name) : std::to_string(coord);
}

std::string coord_and_number(std::int32_t coord) {
  const auto number = std::to_string(coord), text = coord_text(coord);
  return text == number ? number : text + " (" + number + ")";
}

}  // namespace hc
