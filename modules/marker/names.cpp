// SPDX-License-Identifier: Apache-2.0
#include "names.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include <hc/base/text.h>
#include <hc/base/words.h>

namespace {

using hc::vision::MarkerKind;

std::optional<MarkerKind> kind_of(std::string_view word) {
  if (word == "aruco") return MarkerKind::Aruco;
  if (word == "apriltag") return MarkerKind::AprilTag;
  if (word == "colour") return MarkerKind::Colour;
  return std::nullopt;
}

int hue_distance(int a, int b) {
  const int d = std::abs(a - b) % 360;
  return std::min(d, 360 - d);
}

}  // namespace

hc::Result<std::vector<NamedMarker>> read_names(const std::string& text, double least, double most,
                                                bool whole) {
  std::vector<NamedMarker> names;
  for (const auto word : hc::words_of(text, " ,\t\n")) {
    const std::size_t colon = word.find(':'), equals = word.find('=');
    auto wrong = [&](const char* why) {
      return hc::Error{hc::Code::Invalid, "\"" + std::string(word) + "\" " + why};
    };
    if (colon == word.npos || equals == word.npos || equals < colon)
      return wrong("is not like aruco:23=VALUE");
    NamedMarker name;
    const auto kind = kind_of(word.substr(0, colon));
    if (!kind) return wrong("is not one of aruco, apriltag, colour");
    name.kind = *kind;
    const auto id = word.substr(colon + 1, equals - colon - 1);
    const int most_id = *kind == MarkerKind::Colour ? 359 : 100000;
    if (!hc::read_number(id, name.id) || name.id < 0 || name.id > most_id)
      return wrong(*kind == MarkerKind::Colour ? "needs a hue from 0 to 359" : "needs a number");
    if (!hc::read_number(word.substr(equals + 1), name.value) || !(name.value >= least) ||
        !(name.value <= most) || (whole && name.value != std::floor(name.value)))
      return wrong("has a value out of range");
    for (const auto& other : names)
      if (other.kind == name.kind && other.id == name.id) return wrong("is repeated");
    names.push_back(name);
  }
  return names;
}

std::optional<NamedMarker> find_name(const std::vector<NamedMarker>& names, MarkerKind kind,
                                     int id) {
  std::optional<NamedMarker> best;
  constexpr int kAlike = 20;  // [degree]
  for (const auto& name : names) {
    if (name.kind != kind) continue;
    const int distance =
        kind == MarkerKind::Colour ? hue_distance(name.id, id) : (name.id == id ? 0 : kAlike + 1);
    if (distance <= kAlike && (!best || distance < hue_distance(best->id, id))) best = name;
  }
  return best;
}
