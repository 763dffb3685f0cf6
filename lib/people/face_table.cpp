// SPDX-License-Identifier: Apache-2.0
#include <people/face_table.h>

#include <array>

#include <hc/base/table_row.h>

namespace hc::people {
namespace {

constexpr std::array<const char*, 2 * Face::kPoints> kPointNames = {
    "right eye x", "right eye y", "left eye x",  "left eye y",  "nose x",     "nose y",
    "mouth x",     "mouth y",     "right ear x", "right ear y", "left ear x", "left ear y"};

struct FaceColumns {
  static void visit(auto& row, auto&& column) {
    auto& face = row.face;
    column("x", "px", face.box.x);
    column("y", "px", face.box.y);
    column("width", "px", face.box.width);
    column("height", "px", face.box.height);
    column("score", "", face.score);
    column("track", "", row.track, 1.0);
    column("person", "", row.person, 0.0);
    for (std::size_t i = 0; i < Face::kPoints; ++i) {
      column(kPointNames[2 * i], "px", face.points[i].x);
      column(kPointNames[2 * i + 1], "px", face.points[i].y);
    }
    column("roll", "rad", face.roll());
    column("yaw", "rad", face.yaw());
    column("x", "m", row.place.x());
    column("y", "m", row.place.y());
    column("z", "m", row.place.z());
  }
};

}  // namespace

std::vector<std::string> face_columns() {
  return column_names<FaceColumns, FaceRow>();
}

void write(const FaceRow& face, std::span<double> row) {
  write_row<FaceColumns>(face, row);
}

std::optional<FaceRow> face_in(std::span<const double> row) {
  return read_row<FaceColumns, FaceRow>(row);
}

bool can_be_face(const Eigen::Vector3d& p_head) {
  constexpr double kNearest = 0.1, kFarthest = 100;
  return p_head.norm() >= kNearest && p_head.norm() <= kFarthest;
}

}  // namespace hc::people
