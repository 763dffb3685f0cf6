// SPDX-License-Identifier: Apache-2.0
#pragma once
// Finds markers in images, and their poses.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <hc/module/module.h>
#include <vision/calibration.h>
#include <vision/marker.h>
#include <vision/marker_finder.h>
#include <vision/module_cameras.h>
#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "names.h"

struct MarkerParameters {
  hc::Module& module;

  hc::Parameter<std::string> marker_frames = module.parameter(
      "marker_frames", "", "", "numbers of markers' frames, e.g. \"aruco:23=101 colour:300=103\"");
  hc::Parameter<std::string> sides =
      module.parameter("sides", "", "m", "of single markers, e.g. \"aruco:23=0.18\"");
  hc::Parameter<double> side =
      module.parameter("side", 0.1, "m", "of all other markers' black or coloured square",
                       {.min = 1e-4, .max = 100});
  hc::Parameter<bool> named_only = module.parameter(
      "named_only", false, "", "report only markers that marker_frames or sides name");
  hc::Parameter<bool> aruco = module.parameter("aruco", true, "", "look for ArUco markers");
  hc::Parameter<std::string> dictionary =
      module.parameter("dictionary", "6X6_250", "",
                       "of the ArUco markers, e.g. 4X4_50, ARUCO_ORIGINAL", {.fixed = true});
  hc::Parameter<bool> apriltag =
      module.parameter("apriltag", true, "", "look for AprilTags (36h11)");
  hc::Parameter<double> decimate =
      module.parameter("decimate", 1.0, "", "AprilTags: 2 is three times as fast, but misses some",
                       {.min = 1, .max = 8, .fixed = true});
  hc::Parameter<bool> colour =
      module.parameter("colour", true, "", "look for coloured squares on white");
  hc::Parameter<std::string> calibration_file =
      module.parameter("calibration_file", "", "",
                       "file of stereo_calibration, instead of focal, cx, cy", {.fixed = true});
  hc::Parameter<double> focal = module.parameter(
      "focal", hc::vision::kUnknownFocal, "px",
      "focal length; 0: unknown, the image's width is assumed", {.min = 0, .max = 1e6});
  hc::Parameter<double> cx = module.parameter("cx", -1.0, "px", "principal point, -1: the middle",
                                              {.min = -1, .max = 65535});
  hc::Parameter<double> cy =
      module.parameter("cy", -1.0, "px", "the same, from the top", {.min = -1, .max = 65535});

  /// The camera without a calibration.
  [[nodiscard]] hc::vision::EyeCamera camera(double known_focal, const cv::Size& image) const {
    return {{{known_focal, known_focal, *cx < 0 ? (image.width - 1) / 2.0 : *cx,
              *cy < 0 ? (image.height - 1) / 2.0 : *cy},
             {}}};
  }
};

class MarkerSearch {
 public:
  /// @param module  must outlive it.
  explicit MarkerSearch(hc::Module& module);

 private:
  using Marker = hc::vision::Marker;
  struct Found {
    Marker marker;
    double side = 0;
    hc::vision::MarkerPose pose;
    std::int32_t frame = 0;

    [[nodiscard]] Eigen::Isometry3d T_eye_marker() const;
  };

  void start();
  void read_parameters();
  void look(const hc::Message& message);
  [[nodiscard]] hc::vision::EyeCamera camera_of(std::int32_t coord, const cv::Size& image);
  [[nodiscard]] std::vector<Marker> find(const cv::Mat& pixels);
  /// The marker by its names, and its pose; nothing if it is not to be reported.
  [[nodiscard]] std::optional<Found> place(const Marker& marker,
                                           const hc::vision::EyeCamera& view) const;
  void send_poses(const std::vector<Found>& all, std::int32_t eye);
  void send_table(const std::vector<Found>& all, std::int32_t eye);

  hc::Module& module_;
  hc::Input<hc::ImageKind> image_ =
      module_.input("image", hc::image(),
                    "image of the left eye, unless its coordinate system is the right one's");
  hc::Output<hc::TransformationKind<double>> poses_ =
      module_.output("poses", hc::transformation(),
                     "T_eye_marker, one a marker: x right, y down, z into the marker as "
                     "seen by the viewer, origin in its middle [m]; coord = 1000 · eye + "
                     "frame of the marker, 0 where it has none");
  hc::Output<hc::TableKind<double>> markers_ = module_.output(
      "markers", hc::table().of(0, hc::vision::kMarkerColumns),
      "a row each, in the eye, which is coord; kind: 0 aruco, 1 apriltag, 2 colour; id: hue "
      "[degree] "
      "of colour; size: mean side; ambiguity: the angle to another rotation that fits about as "
      "well, "
      "else 0",
      {.columns = {"kind", "id", "side [m]", "x [m]", "y [m]", "z [m]", "qx", "qy", "qz", "qw",
                   "reprojection error [px]", "size [px]", "ambiguity [rad]"}});
  const MarkerParameters parameters_{module_};

  hc::vision::AssumedCameras assumed_{module_, "distances have no true scale",
                                      "set calibration_file or focal"};
  std::optional<hc::vision::StereoCalibration> calibration_;
  std::optional<hc::vision::ArucoFinder> aruco_;
  std::optional<hc::vision::AprilTagFinder> apriltag_;
  std::string frames_read_, sides_read_;
  std::vector<NamedMarker> frame_names_, side_names_;
};
