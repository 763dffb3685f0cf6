// SPDX-License-Identifier: Apache-2.0
#include "score.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <hc/base/format.h>
#include <hc/base/text.h>
#include <people/person_name.h>

namespace {

/// Less of a face cannot be found. [share]
constexpr double kVisible = 0.2;
/// A face that is farther from a person's is not theirs, and no nearer to it than to another's by
/// this may be either. [widths of the true face]
constexpr double kSame = 0.5, kClear = 0.25;

}  // namespace

std::optional<int> person_at(const std::vector<TruePerson>& people, const SeenFace& face) {
  double nearest = std::numeric_limits<double>::infinity(), second = nearest;
  int number = 0;
  for (const auto& person : people) {
    if (person.visible < kVisible || !(person.width > 0)) continue;
    const double apart = std::hypot(face.u - person.u, face.v - person.v) / person.width;
    if (apart < nearest) {
      second = nearest;
      nearest = apart;
      number = person.number;
    } else if (apart < second) {
      second = apart;
    }
  }
  if (nearest >= kSame || second - nearest < kClear) return std::nullopt;
  return number;
}

std::map<int, int> persons_named(std::string_view lines) {
  std::map<int, int> persons;
  while (!lines.empty()) {
    const auto named = hc::people::numbered_name(hc::take_until(lines, '\n'));
    if (!named || named->name.empty()) continue;
    int& person = persons[named->number];
    if (!hc::read_number(named->name, person)) person = 0;
  }
  return persons;
}

void IdentityScore::look(const std::vector<TruePerson>& people,
                         const std::vector<SeenFace>& faces) {
  for (const auto& face : faces) {
    const auto person = person_at(people, face);
    if (!person) continue;
    ++looks_;
    check_track(*person, face.track);
    if (face.known != 0 && !persons_.empty()) check_name(*person, face.known);
  }
}

void IdentityScore::check_name(int person, int known) {
  const auto named = persons_.find(known);
  const bool is_wrong = named == persons_.end() || named->second != person;
  ++named_;
  wrong_ += is_wrong;
  bool& was_wrong = is_wrong_[person];
  swapped_names_ += is_wrong && !was_wrong;
  was_wrong = is_wrong;
}

void IdentityScore::check_track(int person, int track) {
  const auto [before, is_new] = person_of_.try_emplace(track, person);
  swapped_tracks_ += before->second != person;
  before->second = person;
}

std::array<double, 5> IdentityScore::numbers() const {
  return {double(looks_), double(named_), double(wrong_), double(swapped_names_),
          double(swapped_tracks_)};
}

std::string IdentityScore::text() const {
  if (looks_ == 0) return "no person's face was found";
  return hc::format("{} looks, {} with a name, {} with another's, {} names and {} tracks swapped",
                    looks_, named_, wrong_, swapped_names_, swapped_tracks_);
}
