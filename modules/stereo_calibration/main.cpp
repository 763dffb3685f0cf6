// SPDX-License-Identifier: Apache-2.0
// The geometry of two cameras, from images of a chessboard.
#include <algorithm>
#include <vector>

#include <hc/base/format.h>
#include <hc/module/module.h>
#include <vision/calibration.h>
#include <vision/messages.h>

namespace {

hc::AnyKind image(std::int32_t coord) {
  return hc::any_of(hc::rgb_image<std::uint8_t>().in(coord),
                    hc::intensity_image<std::uint8_t>().in(coord));
}

}  // namespace

int main(int argc, char** argv) {
  hc::Module module{"stereo_calibration",
                    "Finds the geometry of two cameras from views of a chessboard."};
  auto left = module.input("left", image(hc::Coord::kLeftImage), "image of the left eye");
  auto right =
      module.input("right", image(hc::Coord::kRightImage), "the right eye's of the same time");
  auto found = module.output("view", hc::table<double>(),
                             "views so far, views wanted, with each that is taken");
  auto result = module.output("score", hc::table<double>(),
                              "reprojection error of the pair, the left, the right camera [px], "
                              "mean difference of rows [px], baseline [m], views used");
  auto file = module.parameter("calibration_file", "calibration.yml", "", "where it is written",
                               {.positional = true, .fixed = true});
  auto wanted = module.parameter("views", 20, "", "how many views to take",
                                 {.min = hc::vision::kLeastViews, .max = 200});
  auto columns = module.parameter("columns", 9, "", "inner corners in a row of the board",
                                  {.min = 3, .max = 50, .fixed = true});
  auto rows = module.parameter("rows", 6, "", "inner corners in a column, another number",
                               {.min = 3, .max = 50, .fixed = true});
  auto square = module.parameter("square", 0.025, "m", "side of a square",
                                 {.min = 1e-4, .max = 10, .fixed = true});
  auto min_difference = module.parameter(
      "difference", 0.02, "",
      "of the images' width: minimum distance of the corners from those of any other view's",
      {.min = 0, .max = 1});

  hc::vision::Board board;
  std::vector<hc::vision::BoardView> views;
  cv::Size size;
  std::int64_t time = 0;  // of the last view
  bool is_done = false;
  auto finish = [&] {
    is_done = true;
    auto calibrated = hc::value_or_end(hc::vision::calibrate(views, board, size));
    const auto& calibration = calibrated.calibration;
    if (auto written = hc::vision::write_calibration(*file, calibration); !written)
      throw hc::ModuleError(written.error());
    result.send(
        hc::table({calibration.rms, calibrated.rms_left, calibrated.rms_right, calibrated.epipolar,
                   calibration.baseline(), static_cast<double>(calibrated.views)})
            .at(time));
    module.log(hc::format(
        "rms {:.3f} px (left {:.3f}, right {:.3f}), rows differ by {:.3f} px, baseline {:.4f} m, "
        "{} of {} views: {}",
        calibration.rms, calibrated.rms_left, calibrated.rms_right, calibrated.epipolar,
        calibration.baseline(), calibrated.views, views.size(), *file));
  };
  module.on_start([&] {
    if (*columns == *rows)
      throw hc::ModuleError(hc::Error{hc::Code::Invalid, "columns and rows are the same number"});
    board = {static_cast<int>(*columns), static_cast<int>(*rows), *square};
  });
  module.on(hc::together(left, right), [&](const hc::Message& l, const hc::Message& r) {
    if (is_done) return;
    const cv::Mat left_mat = hc::value_or_end(hc::as_mat(l));
    const cv::Mat right_mat = hc::value_or_end(hc::as_mat(r));
    if (left_mat.size() != right_mat.size() || (size.area() > 0 && left_mat.size() != size))
      throw hc::ModuleError("the images have different sizes");
    size = left_mat.size();
    auto view = hc::vision::find_board(left_mat, right_mat, board);
    if (!view) return;
    const double far = *min_difference * size.width;
    if (std::any_of(views.begin(), views.end(),
                    [&](const auto& other) { return hc::vision::difference(*view, other) < far; }))
      return;
    views.push_back(std::move(*view));
    time = std::max(l.header.time, r.header.time);
    found.send(hc::table({static_cast<double>(views.size()), static_cast<double>(*wanted)}));
    if (views.size() >= static_cast<std::size_t>(*wanted)) finish();
  });
  module.on_end([&] {
    if (!is_done) finish();
  });
  return module.run(argc, argv);
}
