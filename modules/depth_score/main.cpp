// SPDX-License-Identifier: Apache-2.0
// Compares a disparity map with ground truth.
#include <string>

#include <hc/base/format.h>
#include <hc/module/module.h>
#include <transports/all.h>
#include <vision/messages.h>
#include <vision/stereo/score.h>
#include <opencv2/imgproc.hpp>

int main(int argc, char** argv) {
  hc::add_all_transports();
  hc::Module module{"depth_score", "Compares disparities with the true ones."};
  auto disparity =
      module.input("disparity", hc::intensity_image<float>(), "as found [px], 0 unknown");
  auto truth = module.input("truth", hc::image(), "true disparity in grey levels, 0 unknown");
  auto result = module.output(
      "score", hc::table(),
      "share of bad pixels among the valid, of holes, of bad or hole; pixels with known truth");
  auto truth_scale =
      module.parameter("truth_scale", 1.0, "px", "disparity of one grey level", {.min = 1e-6});
  auto threshold =
      module.parameter("threshold", 2.0, "px", "larger errors count as bad", {.min = 0});

  module.on(hc::together(disparity, truth), [&](const hc::Message& found,
                                                const hc::Message& known) {
    cv::Mat levels = hc::value_or_drop(hc::as_mat(known));
    if (levels.channels() > 1) cv::extractChannel(levels.clone(), levels, 0);
    const cv::Mat found_mat = hc::value_or_drop(hc::as_mat(found));
    if (found_mat.size() != levels.size())
      throw hc::BadMessage("the disparities and the truth have different sizes");
    cv::Mat true_mat;
    levels.convertTo(true_mat, CV_32F, *truth_scale);
    auto score = hc::vision::score(found_mat, true_mat, *threshold);
    result.send({score.bad_share(), score.hole_share(), score.wrong_share(),
                           static_cast<double>(score.truth)});
    module.log(hc::format("bad pixels {:.2f} % of valid ones (error over {:g} px), holes {:.2f} "
                          "%, bad or hole {:.2f} %, of {} pixels with known truth",
                          100 * score.bad_share(), *threshold, 100 * score.hole_share(),
                          100 * score.wrong_share(), score.truth),
               hc::Level::Result);
  });
  return module.run(argc, argv);
}
