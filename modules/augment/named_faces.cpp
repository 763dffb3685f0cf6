// SPDX-License-Identifier: Apache-2.0
#include "named_faces.h"

#include <algorithm>
#include <optional>
#include <utility>

#include <hc/base/format.h>
#include <hc/base/json_string.h>
#include <hc/base/text.h>
#include <hc/base/visible.h>

namespace {

constexpr int kMostPerson = 1'000'000'000;  // largest number

/// Whether a head can be there.
bool is_place_of_head(const Eigen::Vector3d& p_head) {
  constexpr double kNearest = 0.1, kFarthest = 100;  // [m]
  return p_head.norm() >= kNearest && p_head.norm() <= kFarthest;
}

/// A name that can be drawn, and is not too long.
std::string shown(std::string_view name) {
  constexpr std::size_t kLongestLetter = 4;  // of UTF-8 [byte]
  const auto most = NamedFaces::kMostLetters;
  const std::string text = hc::visible(name.substr(0, kLongestLetter * most));
  std::size_t end = 0;
  for (std::size_t i = 0; i < most && end < text.size(); ++i)
    end += hc::utf8_length(std::string_view(text).substr(end));
  return end < text.size() ? text.substr(0, end) + "..." : text;
}

/// Person and name, from "PERSON NAME".
std::optional<std::pair<int, std::string>> read_name(std::string_view line) {
  int person = 0;
  const auto number = hc::take_until(line, ' ');
  if (!hc::read_number(number, person) || person < 1 || person > kMostPerson || line.empty())
    return std::nullopt;
  return std::pair(person, shown(line));
}

}  // namespace

std::vector<NamedFaces::Face> NamedFaces::read(const hc::MatrixView<const double>& table) {
  constexpr std::size_t kPerson = 6, kPlace = 21;  // columns
  std::vector<Face> faces;
  for (std::size_t y = 0; y < table.height(); ++y) {
    const auto row = table.row(y);
    const double person = row[kPerson];
    const Eigen::Vector3d p_head(row[kPlace], row[kPlace + 1], row[kPlace + 2]);
    if (!(person >= 1 && person <= kMostPerson) || !is_place_of_head(p_head)) continue;
    faces.push_back({static_cast<int>(person), p_head});
  }
  std::ranges::stable_sort(faces, {}, [](const Face& face) { return face.p_head.norm(); });
  if (faces.size() > kMostFaces) faces.resize(kMostFaces);
  return faces;
}

void NamedFaces::see(hc::Time time, const std::vector<Face>& faces,
                     const Eigen::Isometry3d& T_world_head) {
  time_ = time;
  seen_.clear();
  for (const auto& face : faces) seen_.push_back({face.person, T_world_head * face.p_head});
}

hc::Status NamedFaces::name(std::string_view lines) {
  std::map<int, std::string> names;
  hc::Status status;
  while (!lines.empty()) {
    const auto line = hc::take_until(lines, '\n');
    auto name = read_name(line);
    if (name && names.size() < kMostNames) {
      names.insert(std::move(*name));
      continue;
    }
    if (status)
      status = hc::Error{hc::Code::Malformed,
                         name ? hc::format("there are more than {} names", kMostNames)
                              : hc::format("\"{}\" is not PERSON NAME", shown(line))};
    if (name) break;
  }
  names_ = std::move(names);
  return status;
}

std::vector<NamedFace> NamedFaces::at(hc::Time time) const {
  std::vector<NamedFace> faces;
  if (std::chrono::abs(time - time_) > kLife) return faces;
  for (const auto& [person, p_world] : seen_)
    if (const auto name = names_.find(person); name != names_.end())
      faces.push_back({name->second, p_world});
  return faces;
}
