// SPDX-License-Identifier: Apache-2.0
#include <people/face_table.h>

#include <cstddef>

#include <hc/base/check.h>
#include <people/short_number.h>
#include <people/table_row.h>

namespace hc::people {
namespace {

/// The columns of its numbers.
struct FaceAt {
  static constexpr std::size_t kBox = 0, kScore = 4, kTrack = 5, kPerson = 6, kPoints = 7,
                               kPlace = 21;
};

}  // namespace

std::vector<std::string> face_columns() {
  std::vector<std::string> columns{"x [px]", "y [px]", "width [px]", "height [px]",
                                   "score",  "track",  "person"};
  for (const std::string point :
       {"right eye", "left eye", "nose", "mouth", "right ear", "left ear"})
    for (const auto* axis : {" x [px]", " y [px]"}) columns.push_back(point + axis);
  for (const auto* last : {"roll [rad]", "yaw [rad]", "x [m]", "y [m]", "z [m]"})
    columns.emplace_back(last);
  return columns;
}

void write(const FaceRow& from, std::span<double> row) {
  HC_CHECK(row.size() == static_cast<std::size_t>(kFaceColumns), row.size());
  const auto& [face, track, person, place] = from;
  auto to = row.begin();
  for (const float each : {face.box.x, face.box.y, face.box.width, face.box.height})
    *to++ = short_pixel(each);
  *to++ = short_number(face.score);
  *to++ = track;
  *to++ = person;
  for (const auto& point : face.points) {
    *to++ = short_pixel(point.x);
    *to++ = short_pixel(point.y);
  }
  *to++ = short_number(face.roll());
  *to++ = short_number(face.yaw());
  for (const double each : place) *to++ = short_number(each);
}

bool can_be_face(const Eigen::Vector3d& p_head) {
  constexpr double kNearest = 0.1, kFarthest = 100;
  return p_head.norm() >= kNearest && p_head.norm() <= kFarthest;
}

std::optional<FaceRow> face_in(std::span<const double> row) {
  if (!is_row(row, kFaceColumns) || !is_count(row[FaceAt::kTrack], 1) ||
      !is_count(row[FaceAt::kPerson], 0))
    return std::nullopt;
  FaceRow face;
  const cv::Point2f size = pixel_of(row, FaceAt::kBox + 2);
  face.face.box = {pixel_of(row, FaceAt::kBox), cv::Size2f(size.x, size.y)};
  face.face.score = static_cast<float>(row[FaceAt::kScore]);
  face.track = static_cast<int>(row[FaceAt::kTrack]);
  face.person = static_cast<int>(row[FaceAt::kPerson]);
  for (std::size_t i = 0; i < face.face.points.size(); ++i)
    face.face.points[i] = pixel_of(row, FaceAt::kPoints + 2 * i);
  const auto place = row.subspan(FaceAt::kPlace);
  face.place = {place[0], place[1], place[2]};
  return face;
}

}  // namespace hc::people
