// SPDX-License-Identifier: Apache-2.0
#include "names.h"

#include <charconv>
#include <cmath>
#include <cstdlib>

#include <algorithm>

namespace {

using hc::vision::MarkerKind;

std::optional<MarkerKind> kind_of(std::string_view word) {
  if (word == "aruco") return MarkerKind::Aruco;
  if (word == "apriltag") return MarkerKind::AprilTag;
  if (word == "colour") return MarkerKind::Colour;
  return std::nullopt;
}

template <typename T>
bool read_whole(std::string_view text, T& number) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc() && end == text.data() + text.size() && std::isfinite(double(number));
}

int hue_distance(int a, int b) {
  const int d = std::abs(a - b) % 360;
  return std::min(d, 360 - d);
}

}  // namespace

hc::Result<std::vector<NamedMarker>> read_names(const std::string& text, double least, double most,
                                                bool whole) {
  std::vector<NamedMarker> names;
  constexpr std::string_view kBetween = " ,\t\n";
  for (std::size_t at = text.find_first_not_of(kBetween); at != std::string::npos;) {
    const std::size_t end = std::min(text.find_first_of(kBetween, at), text.size());
    const std::string word = text.substr(at, end - at);
    const std::size_t colon = word.find(':'), equals = word.find('=');
    auto wrong = [&](const char* why) {
      return hc::Error{hc::Code::Invalid, "\"" + word + "\" " + why};
    };
    if (colon == std::string::npos || equals == std::string::npos || equals < colon)
      return wrong("is not as in aruco:23=VALUE");
    NamedMarker name;
    const auto kind = kind_of(std::string_view(word).substr(0, colon));
    if (!kind) return wrong("is none of aruco, apriltag and colour");
    name.kind = *kind;
    const auto id = std::string_view(word).substr(colon + 1, equals - colon - 1);
    const int most_id = *kind == MarkerKind::Colour ? 359 : 100000;
    if (!read_whole(id, name.id) || name.id < 0 || name.id > most_id)
      return wrong(*kind == MarkerKind::Colour ? "has no hue from 0 to 359" : "has no number");
    if (!read_whole(std::string_view(word).substr(equals + 1), name.value) || name.value < least ||
        name.value > most || (whole && name.value != std::floor(name.value)))
      return wrong("has a value that is not taken");
    for (const auto& other : names)
      if (other.kind == name.kind && other.id == name.id) return wrong("is there twice");
    names.push_back(name);
    at = text.find_first_not_of(kBetween, end);
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
