// SPDX-License-Identifier: Apache-2.0
#include "marker.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <frames/messages.h>
#include <hc/base/format.h>
#include <vision/image.h>
#include <vision/messages.h>

namespace {

using hc::Coord;

bool is_rectified(std::int32_t coord) {
  return coord == Coord::kLeftRectified || coord == Coord::kRightRectified;
}

bool is_right(std::int32_t coord) {
  return coord == Coord::kRightImage || coord == Coord::kRightRectified;
}

}  // namespace

Eigen::Isometry3d MarkerSearch::Found::T_eye_marker() const {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(pose.R.val);
  T.translation() = Eigen::Map<const Eigen::Vector3d>(pose.t.val);
  return T;
}

MarkerSearch::MarkerSearch(hc::Module& module) : module_(module) {
  module.on_start([this] { start(); });
  module.on(image_, [this](const hc::Message& message) { look(message); });
}

void MarkerSearch::start() {
  read_parameters();
  const auto& dictionary = parameters_.dictionary;
  aruco_ = hc::value_or_refuse(dictionary, hc::vision::ArucoFinder::make(*dictionary));
  apriltag_.emplace(*parameters_.decimate);
  if (const auto& file = parameters_.calibration_file; !file->empty())
    calibration_ = hc::value_or_refuse(file, hc::vision::read_calibration(*file));
}

void MarkerSearch::read_parameters() {
  const auto &frames = *parameters_.marker_frames, &sides = *parameters_.sides;
  if (frames_read_ != frames)
    frame_names_ = hc::value_or_end(read_names(frames_read_ = frames, 1, 999, true));
  if (sides_read_ != sides)
    side_names_ = hc::value_or_end(read_names(sides_read_ = sides, 1e-4, 100, false));
}

void MarkerSearch::look(const hc::Message& message) {
  read_parameters();
  const cv::Mat pixels = hc::value_or_drop(hc::as_mat(message));
  if (pixels.empty()) return;
  const auto coord = message.header.coord;
  const auto view = camera_of(coord, pixels.size());
  std::vector<Found> all;
  for (const auto& marker : find(pixels))
    if (auto found = place(marker, view)) all.push_back(*found);
  if (all.empty()) return;
  const std::int32_t frame = is_right(coord) ? Coord::kRightEye : Coord::kLeftEye;
  if (poses_.linked()) send_poses(all, frame);
  if (markers_.linked()) send_table(all, frame);
}

hc::vision::EyeCamera MarkerSearch::camera_of(std::int32_t coord, const cv::Size& image) {
  if (!calibration_)
    return parameters_.camera(assumed_.focal(*parameters_.focal, image.width), image);
  if (calibration_->size.area() > 0 && calibration_->size != image)
    throw hc::BadMessage("the calibration is for images of another size");
  const auto eye = is_right(coord) ? hc::vision::Eye::Right : hc::vision::Eye::Left;
  return hc::vision::camera_of(*calibration_, eye, is_rectified(coord));
}

std::vector<hc::vision::Marker> MarkerSearch::find(const cv::Mat& pixels) {
  const cv::Mat grey = hc::vision::grey_of(pixels);
  std::vector<Marker> all;
  auto add = [&](const std::vector<Marker>& some) {
    all.insert(all.end(), some.begin(), some.end());
  };
  if (*parameters_.aruco) add(aruco_->find(grey));
  if (*parameters_.apriltag) add(apriltag_->find(grey));
  if (*parameters_.colour && pixels.channels() == 3) add(hc::vision::find_colour_markers(pixels));
  return all;
}

std::optional<MarkerSearch::Found> MarkerSearch::place(const Marker& marker,
                                                       const hc::vision::EyeCamera& view) const {
  Found found{marker, *parameters_.side, {}, 0};
  const auto its_side = find_name(side_names_, marker.kind, marker.id);
  const auto its_frame = find_name(frame_names_, marker.kind, marker.id);
  if (*parameters_.named_only && !its_side && !its_frame) return std::nullopt;
  if (its_side) found.side = its_side->value;
  if (its_frame) found.frame = static_cast<std::int32_t>(its_frame->value);
  // The named hue, not the measured one, which depends on the light.
  if (its_frame || its_side) found.marker.id = its_frame ? its_frame->id : its_side->id;
  auto pose = hc::vision::pose_of(marker, found.side, view.camera);
  if (!pose) return std::nullopt;
  found.pose = *pose;
  if (pose->ambiguity > 0)
    module_.log_once("ambiguous rotations",
                     hc::format("the rotation of a marker is one of two that fit, {:.0f}° apart",
                                pose->ambiguity * 180 / M_PI));
  found.pose.R = view.R_eye_camera * pose->R;
  found.pose.t = view.R_eye_camera * pose->t;
  return found;
}

void MarkerSearch::send_poses(const std::vector<Found>& all, std::int32_t eye) {
  for (const auto& found : all)
    poses_.send(hc::numbers_of(found.T_eye_marker()), {}, 1000 * eye + found.frame);
}

void MarkerSearch::send_table(const std::vector<Found>& all, std::int32_t eye) {
  auto draft = markers_.loan(static_cast<std::int32_t>(all.size()), hc::vision::kMarkerColumns);
  draft.header.coord = eye;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto& [marker, metres, pose, frame] = all[i];
    Eigen::Quaterniond q(all[i].T_eye_marker().linear());
    if (q.w() < 0) q.coeffs() *= -1;
    const auto& t = pose.t;
    const double kind = static_cast<double>(marker.kind), id = marker.id;
    const std::array row = {kind,          id,    metres, t[0],  t[1],       t[2],
                            q.x(),         q.y(), q.z(),  q.w(), pose.error, marker.mean_side(),
                            pose.ambiguity};
    std::ranges::copy(row, draft.matrix().row(i).begin());
  }
  markers_.send(std::move(draft));
}
