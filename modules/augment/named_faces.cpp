// SPDX-License-Identifier: Apache-2.0
#include "named_faces.h"

#include <algorithm>
#include <utility>

#include <hc/base/format.h>
#include <hc/base/json_string.h>
#include <hc/base/text.h>
#include <hc/base/visible.h>
#include <people/face_table.h>
#include <people/person_name.h>

namespace {

/// A name that can be drawn, and is not too long.
std::string shown(std::string_view name) {
  constexpr std::size_t kLongestLetter = 4;  // of UTF-8 [byte]
  const auto most = NamedFaces::kMostLetters;
  const std::string text = hc::visible(name.substr(0, kLongestLetter * (most + 1)));
  std::size_t end = 0;
  for (std::size_t i = 0; i < most && end < text.size(); ++i)
    end += hc::utf8_length(std::string_view(text).substr(end));
  return end < text.size() ? text.substr(0, end) + "..." : text;
}

}  // namespace

std::vector<NamedFaces::Face> NamedFaces::read(const hc::MatrixView<const double>& table) {
  std::vector<Face> faces;
  for (std::size_t y = 0; y < table.height(); ++y) {
    const auto face = hc::people::face_in(table.row(y));
    if (face && face->person >= 1 && hc::people::can_be_face(face->place))
      faces.push_back({face->person, face->place});
  }
  std::ranges::stable_sort(faces, {}, [](const Face& face) { return face.p_head.norm(); });
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
    const auto named = hc::people::numbered_name(line);
    const bool is_name = named && !named->name.empty();
    if (is_name && names.size() < kMostNames) {
      names.emplace(named->number, shown(named->name));
      continue;
    }
    if (status)
      status = hc::Error{hc::Code::Malformed,
                         is_name ? hc::format("there are more than {} names", kMostNames)
                                 : hc::format("\"{}\" is not PERSON NAME", shown(line))};
    if (is_name) break;
  }
  names_ = std::move(names);
  return status;
}

std::vector<NamedFace> NamedFaces::at(hc::Time time) const {
  std::vector<NamedFace> faces;
  if (std::chrono::abs(time - time_) > kLife) return faces;
  for (const auto& [person, p_world] : seen_)
    if (const auto name = names_.find(person); name != names_.end() && faces.size() < kMostFaces)
      faces.push_back({name->second, p_world});
  return faces;
}
