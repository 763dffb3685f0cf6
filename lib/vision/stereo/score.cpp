// SPDX-License-Identifier: Apache-2.0
#include <vision/stereo/score.h>

#include <cmath>

namespace hc::vision {

StereoScore score(const cv::Mat& disparity, const cv::Mat& truth, double threshold) {
  CV_Assert(disparity.size() == truth.size() && disparity.type() == CV_32F &&
            truth.type() == CV_32F);
  StereoScore score;
  for (int y = 0; y < truth.rows; ++y) {
    const auto* found = disparity.ptr<float>(y);
    const auto* known = truth.ptr<float>(y);
    for (int x = 0; x < truth.cols; ++x) {
      if (known[x] <= 0) continue;
      ++score.truth;
      if (found[x] <= 0)
        ++score.holes;
      else if (std::abs(double{found[x]} - known[x]) > threshold)
        ++score.bad;
    }
  }
  return score;
}

}  // namespace hc::vision
