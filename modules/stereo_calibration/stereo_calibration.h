// SPDX-License-Identifier: Apache-2.0
#pragma once
// Calibrates two cameras from images of a board, and replaces the file unless it is better.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include <hc/module/module.h>
#include <vision/board_views.h>
#include <vision/calibration.h>

struct StereoCalibrationParameters {
  hc::Module& module;

  hc::Parameter<std::string> calibration_file =
      module.parameter("calibration_file", "calibration.yml", "", "where it is written",
                       {.positional = true, .fixed = true});
  hc::Parameter<bool> replace = module.parameter(
      "replace", false, "",
      "replace a file that fits the views too and is no worse; false: the better one stays");
  hc::Parameter<std::int64_t> views =
      module.parameter("views", 20, "", "how many views to take; more if they are not enough",
                       {.min = hc::vision::kLeastViews, .max = 200, .fixed = true});
  hc::Parameter<std::string> board =
      module.parameter("board", "chessboard", "", "kind of board",
                       {.choices = {"chessboard", "charuco", "aprilgrid"}, .fixed = true});
  hc::Parameter<std::int64_t> columns = module.parameter(
      "columns", 9, "",
      "inner corners in a row of a chessboard, squares of a charuco, tags of an aprilgrid",
      {.min = 2, .max = 50, .fixed = true});
  hc::Parameter<std::int64_t> rows =
      module.parameter("rows", 6, "", "the same in a column; of a chessboard not as many",
                       {.min = 2, .max = 50, .fixed = true});
  hc::Parameter<double> square =
      module.parameter("square", 0.025, "m", "side of a square of a chessboard or charuco",
                       {.min = 1e-4, .max = 10, .fixed = true});
  hc::Parameter<double> marker_size = module.parameter(
      "marker_size", 0.0, "m", "side of a marker of a charuco, or of a tag of an aprilgrid",
      {.min = 0, .max = 10, .fixed = true});
  hc::Parameter<double> tag_spacing = module.parameter(
      "tag_spacing", 0.3, "", "gap between the tags of an aprilgrid, relative to marker_size",
      {.min = 0.01, .max = 10, .fixed = true});
  hc::Parameter<std::string> dictionary =
      module.parameter("dictionary", "6X6_250", "",
                       "of the ArUco markers of a charuco, e.g. 4X4_50", {.fixed = true});
  hc::Parameter<std::string> print = module.parameter(
      "print", "", "", "draw the board into this PDF file, in true size, and end", {.fixed = true});
  hc::Parameter<double> difference = module.parameter(
      "difference", 0.02, "",
      "of the images' width: minimum distance of the corners from those of any other view's",
      {.min = 0, .max = 1});

  [[nodiscard]] hc::vision::Board sought_board() const;
};

class StereoCalibration {
 public:
  /// @param module  must outlive it.
  explicit StereoCalibration(hc::Module& module);

 private:
  void start();
  void draw_board() const;
  void look(const hc::Message& left, const hc::Message& right);
  /// Calibrates; a refused calibration is logged, and more views are taken.
  void try_to_finish();
  void finish(const hc::vision::Calibrated& calibrated);
  /// Whether the file is to be written, or the one that exists is as good; logs why.
  [[nodiscard]] bool may_write(const hc::vision::Calibrated& calibrated) const;
  void show(const cv::Mat& left);

  hc::Module& module_;
  hc::Input<hc::ImageKind> left_ =
      module_.input("left", hc::image(hc::Coord::kLeftImage), "image of the left eye");
  hc::Input<hc::ImageKind> right_ = module_.input("right", hc::image(hc::Coord::kRightImage),
                                                  "image of the right eye at the same time");
  hc::Output<hc::TableKind<double>> view_ =
      module_.output("view", hc::table(), "views taken, views wanted; after each view");
  hc::Output<hc::StringKind> advice_ = module_.output(
      "advice", hc::string().in(hc::Coord::kText),
      "what to do next with the board; after each view, empty if nothing is missing");
  hc::Output<hc::RgbImageKind<std::uint8_t>> picture_ = module_.output(
      "picture", hc::rgb_image(),
      "the left image with the corners of the board, where boards were, and advice; on demand",
      {.on_demand = true});
  hc::Output<hc::TableKind<double>> score_ = module_.output(
      "score", hc::table(),
      "reprojection error of the pair, the left, the right camera [px], mean difference of rows "
      "[px], baseline [m], views used; standard deviations of the focal lengths and the baseline, "
      "relative, and of the place of a far point [px]");
  const StereoCalibrationParameters parameters_{module_};

  std::optional<hc::vision::BoardViews> views_;               // until the calibration
  std::optional<hc::vision::StereoCalibration> calibration_;  // in the file at the start
  hc::Time time_;                                             // of the last view
  std::int64_t untried_ = 0;                                  // views since the last attempt
  bool was_refused_ = false;
};
