// SPDX-License-Identifier: Apache-2.0
#include <vision/stereo/speckles.h>

#include <gtest/gtest.h>

#include <opencv2/calib3d.hpp>

namespace hc::vision {
namespace {

TEST(Speckles, AreThoseOfOpenCv) {
  cv::RNG rng(3);
  SpeckleFilter filter;
  for (int i = 0; i < 200; ++i) {
    const cv::Size size(rng.uniform(1, 40), rng.uniform(1, 200));  // some of several bands
    cv::Mat disparity(size, CV_16S);
    rng.fill(disparity, cv::RNG::UNIFORM, 0, rng.uniform(2, 12));
    cv::Mat expected = disparity.clone(), found;
    disparity.convertTo(found, CV_16U);
    const int min_size = rng.uniform(0, 60), range = rng.uniform(0, 4);
    cv::filterSpeckles(expected, 0, min_size - 1, range);  // clears up to its limit
    filter.remove(found, min_size, range);
    expected.convertTo(expected, CV_16U);
    ASSERT_EQ(cv::norm(found, expected, cv::NORM_INF), 0)
        << size << ", " << min_size << ", " << range;
  }
}

}  // namespace
}  // namespace hc::vision
