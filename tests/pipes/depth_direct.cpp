// SPDX-License-Identifier: Apache-2.0
// What graphs/depth.toml computes, in one process and with OpenCV alone, but for the cutting of the
// images. Prints the sentence that depth_score says.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <string>

#include <vision/image.h>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

int main(int, char** argv) {
  std::string folder = argv[1];
  cv::Mat left = hc::vision::fit(cv::imread(folder + "/aloeL.jpg"), 800, 600);
  cv::Mat right = hc::vision::fit(cv::imread(folder + "/aloeR.jpg"), 800, 600);
  cv::Mat truth =
      hc::vision::fit(cv::imread(folder + "/aloeGT.png", cv::IMREAD_GRAYSCALE), 800, 600, false);
  cv::cvtColor(left, left, cv::COLOR_BGR2GRAY);
  cv::cvtColor(right, right, cv::COLOR_BGR2GRAY);
  cv::Mat found;
  cv::StereoSGBM::create(0, 128, 5, 8 * 25, 32 * 25, 1, 63, 10, 100, 2,
                         cv::StereoSGBM::MODE_SGBM_3WAY)
      ->compute(left, right, found);

  double known = 0, holes = 0, bad = 0;
  for (int y = 0; y < truth.rows; ++y) {
    for (int x = 0; x < truth.cols; ++x) {
      if (truth.at<std::uint8_t>(y, x) == 0) continue;
      ++known;
      double disparity = found.at<std::int16_t>(y, x) / 16.0;
      double error = std::abs(disparity - truth.at<std::uint8_t>(y, x) * 0.62402);
      if (disparity <= 0)
        ++holes;
      else if (error > 2)
        ++bad;
    }
  }
  std::printf(
      "bad pixels %.2f %% of valid ones (error over 2 px), holes %.2f %%, bad or hole %.2f %%, of "
      "%.0f pixels with known truth\n",
      100 * bad / (known - holes), 100 * holes / known, 100 * (bad + holes) / known, known);
}
