// SPDX-License-Identifier: Apache-2.0
// Calibrates two cameras from images of a chessboard.
#include <algorithm>
#include <optional>
#include <utility>

#include <hc/module/module.h>
#include <transports/all.h>
#include <vision/board_views.h>
#include <vision/messages.h>

int main(int argc, char** argv) {
  hc::add_all_transports();
  hc::Module module{"stereo_calibration",
                    "Finds the geometry of two cameras from views of a chessboard."};
  auto left = module.input("left", hc::image(hc::Coord::kLeftImage), "image of the left eye");
  auto right = module.input("right", hc::image(hc::Coord::kRightImage),
                            "image of the right eye at the same time");
  auto found = module.output("view", hc::table(), "views taken, views wanted; after each view");
  auto result = module.output("score", hc::table(),
                              "reprojection error of the pair, the left, the right camera [px], "
                              "mean difference of rows [px], baseline [m], views used");
  auto file = module.parameter("calibration_file", "calibration.yml", "", "where it is written",
                               {.positional = true, .fixed = true});
  auto wanted = module.parameter("views", 20, "", "how many views to take",
                                 {.min = hc::vision::kLeastViews, .max = 200});
  auto columns = module.parameter("columns", 9, "", "inner corners in a row of the board",
                                  {.min = 3, .max = 50, .fixed = true});
  auto rows = module.parameter("rows", 6, "", "inner corners in a column, different from columns",
                               {.min = 3, .max = 50, .fixed = true});
  auto square = module.parameter("square", 0.025, "m", "side of a square",
                                 {.min = 1e-4, .max = 10, .fixed = true});
  auto min_difference = module.parameter(
      "difference", 0.02, "",
      "of the images' width: minimum distance of the corners from those of any other view's",
      {.min = 0, .max = 1});

  std::optional<hc::vision::BoardViews> views;  // until the calibration
  hc::Time time;                                // of the last view
  auto finish = [&] {
    if (!views) return;
    const auto calibrated = hc::value_or_end(std::exchange(views, std::nullopt)->calibrate());
    hc::succeed_or_end(hc::vision::write_calibration(*file, calibrated.calibration));
    result.send(calibrated.numbers(), time);
    module.log(calibrated.text() + ": " + *file);
  };
  module.on_start([&] {
    const hc::vision::Board board{static_cast<int>(*columns), static_cast<int>(*rows), *square};
    views.emplace(hc::value_or_end(hc::vision::BoardViews::make(board)));
  });
  module.on(hc::together(left, right), [&](const hc::Message& l, const hc::Message& r) {
    if (!views) return;
    if (!hc::value_or_drop(views->take(hc::value_or_drop(hc::as_mat(l)),
                                       hc::value_or_drop(hc::as_mat(r)), *min_difference)))
      return;
    time = std::max(l.header.time, r.header.time);
    found.send({static_cast<double>(views->size()), static_cast<double>(*wanted)});
    if (views->size() >= static_cast<std::size_t>(*wanted)) finish();
  });
  module.on_end(finish);
  return module.run(argc, argv);
}
