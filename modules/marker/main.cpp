// SPDX-License-Identifier: Apache-2.0
// Finds markers in images, and their poses.
#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include <frames/messages.h>
#include <hc/module/module.h>
#include <transports/all.h>
#include <vision/calibration.h>
#include <vision/image.h>
#include <vision/marker.h>
#include <vision/marker_finder.h>
#include <vision/messages.h>
#include <Eigen/Geometry>

#include "names.h"

namespace {

using hc::Coord;
using hc::vision::Marker;

struct Found {
  Marker marker;
  double side = 0;
  hc::vision::MarkerPose pose;
  std::int32_t frame = 0;

  [[nodiscard]] Eigen::Isometry3d T_eye_marker() const {
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.linear() = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(pose.R.val);
    T.translation() = Eigen::Map<const Eigen::Vector3d>(pose.t.val);
    return T;
  }
};

}  // namespace

int main(int argc, char** argv) {
  hc::add_all_transports();
  hc::Module module{"marker",
                    "Finds ArUco, AprilTag and coloured square markers, and their poses."};
  auto image =
      module.input("image", hc::image(),
                   "image of the left eye, unless its coordinate system is the right one's");
  auto poses = module.output("poses", hc::transformation(),
                             "T_eye_marker, one a marker: x right, y down, z into the marker as "
                             "seen by the viewer, origin in its middle [m]; coord = 1000 · eye + "
                             "frame of the marker, 0 where it has none");
  auto markers = module.output(
      "markers", hc::table().of(0, hc::vision::kMarkerColumns),
      "12 columns, a row each: kind (0 aruco, 1 apriltag, 2 colour), id (hue [degree] of colour), "
      "side [m], x y z [m] and qx qy qz qw in the eye, which is coord, reprojection error, mean "
      "side [px]");
  auto frames = module.parameter(
      "marker_frames", "", "", "numbers of markers' frames, e.g. \"aruco:23=101 colour:300=103\"");
  auto sides = module.parameter("sides", "", "m", "of single markers, e.g. \"aruco:23=0.18\"");
  auto side = module.parameter("side", 0.1, "m", "of all other markers' black or coloured square",
                               {.min = 1e-4, .max = 100});
  auto named_only = module.parameter("named_only", false, "",
                                     "report only markers that marker_frames or sides name");
  auto use_aruco = module.parameter("aruco", true, "", "look for ArUco markers");
  auto dictionary =
      module.parameter("dictionary", "6X6_250", "",
                       "of the ArUco markers, e.g. 4X4_50, ARUCO_ORIGINAL", {.fixed = true});
  auto use_apriltag = module.parameter("apriltag", true, "", "look for AprilTags (36h11)");
  auto decimate =
      module.parameter("decimate", 1.0, "", "AprilTags: 2 is three times as fast, but misses some",
                       {.min = 1, .max = 8, .fixed = true});
  auto use_colour = module.parameter("colour", true, "", "look for coloured squares on white");
  auto file =
      module.parameter("calibration_file", "", "",
                       "file of stereo_calibration, instead of focal, cx, cy", {.fixed = true});
  auto focal = module.parameter("focal", 800.0, "px", "focal length", {.min = 1e-3, .max = 1e6});
  auto cx = module.parameter("cx", -1.0, "px", "principal point, -1: the middle",
                             {.min = -1, .max = 65535});
  auto cy = module.parameter("cy", -1.0, "px", "the same, from the top", {.min = -1, .max = 65535});

  std::optional<hc::vision::StereoCalibration> calibration;
  std::optional<hc::vision::ArucoFinder> aruco;
  std::optional<hc::vision::AprilTagFinder> apriltag;
  std::string frames_read, sides_read;
  std::vector<NamedMarker> frame_names, side_names;
  auto read_parameters = [&] {
    if (frames_read != *frames)
      frame_names = hc::value_or_end(read_names(frames_read = *frames, 1, 999, true));
    if (sides_read != *sides)
      side_names = hc::value_or_end(read_names(sides_read = *sides, 1e-4, 100, false));
  };
  module.on_start([&] {
    read_parameters();
    aruco = hc::value_or_end(hc::vision::ArucoFinder::make(*dictionary));
    apriltag.emplace(*decimate);
    if (!file->empty()) calibration = hc::value_or_end(hc::vision::read_calibration(*file));
  });

  auto look = [&](const cv::Mat& pixels) {
    const cv::Mat grey = hc::vision::grey_of(pixels);
    std::vector<Marker> all;
    auto add = [&](const std::vector<Marker>& some) {
      all.insert(all.end(), some.begin(), some.end());
    };
    if (*use_aruco) add(aruco->find(grey));
    if (*use_apriltag) add(apriltag->find(grey));
    if (*use_colour && pixels.channels() == 3) add(hc::vision::find_colour_markers(pixels));
    return all;
  };
  auto send_poses = [&](const std::vector<Found>& all, std::int32_t eye) {
    for (const auto& found : all)
      poses.send(hc::numbers_of(found.T_eye_marker()), 0, 1000 * eye + found.frame);
  };
  auto send_table = [&](const std::vector<Found>& all, std::int32_t eye) {
    auto draft = markers.loan(static_cast<std::int32_t>(all.size()), hc::vision::kMarkerColumns);
    draft.header.coord = eye;
    for (std::size_t i = 0; i < all.size(); ++i) {
      const auto& [marker, metres, pose, frame] = all[i];
      Eigen::Quaterniond q(all[i].T_eye_marker().linear());
      if (q.w() < 0) q.coeffs() *= -1;
      const auto& t = pose.t;
      const double kind = static_cast<double>(marker.kind), id = marker.id;
      const std::array row = {kind,  id,    metres, t[0],  t[1],       t[2],
                              q.x(), q.y(), q.z(),  q.w(), pose.error, marker.mean_side()};
      std::ranges::copy(row, draft.matrix().row(i).begin());
    }
    markers.send(std::move(draft));
  };

  module.on(image, [&](const hc::Message& message) {
    read_parameters();
    const cv::Mat pixels = hc::value_or_drop(hc::as_mat(message));
    if (pixels.empty()) return;
    const auto coord = message.header.coord;
    const bool is_rectified = coord == Coord::kLeftRectified || coord == Coord::kRightRectified;
    const bool is_right = coord == Coord::kRightImage || coord == Coord::kRightRectified;
    const auto eye = is_right ? hc::vision::Eye::Right : hc::vision::Eye::Left;
    hc::vision::EyeCamera view{{{*focal, *focal, *cx < 0 ? (pixels.cols - 1) / 2.0 : *cx,
                                 *cy < 0 ? (pixels.rows - 1) / 2.0 : *cy},
                                {}}};
    if (calibration) {
      if (calibration->size.area() > 0 && calibration->size != pixels.size())
        throw hc::BadMessage("the calibration is for images of another size");
      view = hc::vision::camera_of(*calibration, eye, is_rectified);
    }
    std::vector<Found> all;
    for (auto& marker : look(pixels)) {
      Found found{marker, *side, {}, 0};
      const auto its_side = find_name(side_names, marker.kind, marker.id);
      const auto its_frame = find_name(frame_names, marker.kind, marker.id);
      if (*named_only && !its_side && !its_frame) continue;
      if (its_side) found.side = its_side->value;
      if (its_frame) found.frame = static_cast<std::int32_t>(its_frame->value);
      // The named hue, not the measured one, which depends on the light.
      if (its_frame || its_side) found.marker.id = its_frame ? its_frame->id : its_side->id;
      auto pose = hc::vision::pose_of(marker, found.side, view.camera);
      if (!pose) continue;
      pose->R = view.R_eye_camera * pose->R;
      pose->t = view.R_eye_camera * pose->t;
      found.pose = *pose;
      all.push_back(found);
    }
    if (all.empty()) return;
    const std::int32_t frame = is_right ? Coord::kRightEye : Coord::kLeftEye;
    if (poses.linked()) send_poses(all, frame);
    if (markers.linked()) send_table(all, frame);
  });
  return module.run(argc, argv);
}
