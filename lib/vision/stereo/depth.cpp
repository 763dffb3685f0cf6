// SPDX-License-Identifier: Apache-2.0
#include <vision/stereo/depth.h>

#include <algorithm>
#include <cstdint>
#include <limits>

namespace hc::vision {

void depth_of(const cv::Mat& disparity, const StereoGeometry& geometry, cv::Mat& depth) {
  depth.create(disparity.size(), CV_32F);
  const auto product = static_cast<float>(geometry.focal * geometry.baseline);
  const auto offset = static_cast<float>(geometry.offset);
  cv::parallel_for_({0, disparity.rows}, [&](const cv::Range& rows) {
    for (int y = rows.start; y < rows.end; ++y) {
      const auto* from = disparity.ptr<float>(y);
      auto* to = depth.ptr<float>(y);
      for (int x = 0; x < disparity.cols; ++x) {
        const float metres = product / (from[x] + offset);
        to[x] = from[x] > 0 ? metres : 0;
      }
    }
  });
}

void points_of(const cv::Mat& depth, const cv::Mat& image, const StereoGeometry& geometry,
               cv::Mat& points) {
  constexpr int kNumbers = 6, kColours = 3;
  constexpr float kWhite = 255;
  const int channels = image.channels();
  const auto cx = static_cast<float>(geometry.cx), cy = static_cast<float>(geometry.cy);
  const auto per_focal = static_cast<float>(1 / geometry.focal);
  points.create(depth.size(), CV_32FC(kNumbers));
  cv::parallel_for_({0, depth.rows}, [&](const cv::Range& rows) {
    for (int y = rows.start; y < rows.end; ++y) {
      const auto* metres = depth.ptr<float>(y);
      const auto* pixel = image.ptr(y);
      auto* point = points.ptr<float>(y);
      for (int x = 0; x < depth.cols; ++x, pixel += channels, point += kNumbers) {
        if (metres[x] <= 0) {
          std::fill_n(point, kNumbers, std::numeric_limits<float>::quiet_NaN());
          continue;
        }
        const float scale = metres[x] * per_focal;
        point[0] = (static_cast<float>(x) - cx) * scale;
        point[1] = (static_cast<float>(y) - cy) * scale;
        point[2] = metres[x];
        for (int c = 0; c < kColours; ++c)
          point[3 + c] = static_cast<float>(pixel[channels == 1 ? 0 : c]) / kWhite;
      }
    }
  });
}

}  // namespace hc::vision
