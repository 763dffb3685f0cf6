// SPDX-License-Identifier: Apache-2.0
#include <vision/letters.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include <opencv2/imgproc.hpp>

namespace hc::vision {

cv::Mat mean_of_channels(const cv::Mat& image) {
  if (image.channels() == 1) return image;
  cv::Mat grey;
  cv::transform(image, grey, cv::Matx13f(1 / 3.0F, 1 / 3.0F, 1 / 3.0F));
  return grey;
}

double noise_of(const cv::Mat& grey) {
  if (grey.rows < 3 || grey.cols < 3) return 0;
  const cv::Matx33f kernel(1, -2, 1, -2, 4, -2, 1, -2, 1);
  cv::Mat rough;
  cv::filter2D(grey, rough, CV_16S, kernel);
  // Every fourth row and column is enough.
  std::vector<int> counts(2048);
  int all = 0;
  for (int y = 1; y < rough.rows - 1; y += 4) {
    const auto* row = rough.ptr<std::int16_t>(y);
    for (int x = 1; x < rough.cols - 1; x += 4) {
      // Saturated pixels are clipped and carry no information.
      const int value = grey.at<std::uint8_t>(y, x);
      if (value < 3 || value > 252) continue;
      ++counts[static_cast<std::size_t>(std::min(2047, std::abs(static_cast<int>(row[x]))))];
      ++all;
    }
  }
  if (all == 0) return 0;
  int below = 0;
  std::size_t middle = 0;
  while (below + counts[middle] <= all / 2) below += counts[middle++];
  // Interpolate within the bin, so that weak noise is not 0.
  const double part = (all / 2.0 - below) / counts[middle];
  const double value = std::max(0.0, static_cast<double>(middle) - 0.5 + part);
  return value / 0.6745 / 6;  // median of |N(0, 1)|; the kernel's norm is 6
}

namespace {

/// Largest for upright letters, whose columns of ink differ most from the gaps between them.
/// Source: A. Vinciarelli, J. Luettin, A new normalization technique for cursive handwritten words,
/// Pattern Recognition Letters 22(9), 2001, in simpler form.
double unevenness_of_columns(const cv::Mat& line) {
  cv::Mat columns, mean, deviation;
  cv::reduce(line, columns, 0, cv::REDUCE_AVG, CV_32F);
  cv::meanStdDev(columns, mean, deviation);
  return deviation.at<double>(0);
}

/// The part of an image that is needed to straighten a line.
cv::Rect part_around(const TextLine& line, const cv::Size& image) {
  const cv::Rect2f around = line.box();
  const auto wider = static_cast<float>(line.height) + 4;
  return cv::Rect(cv::Rect2f(around.x - wider, around.y - wider, around.width + 2 * wider,
                             around.height + 2 * wider)) &
         cv::Rect({}, image);
}

cv::Mat smooth(const cv::Mat& grey, double sigma) {
  cv::Mat result;
  cv::GaussianBlur(grey, result, {}, sigma);
  return result;
}

/// Warps a line to four corners. An inclined line is on a rotated board, with letters inclined by
/// the same angle, or on one seen from the side, with upright letters: gives the one or the other,
/// or what is between them, that has the most upright letters.
cv::Mat warp_upright(const cv::Mat& grey, const TextLine& line, cv::Point2f shift,
                     const std::array<cv::Point2f, 4>& to, const cv::Size& size) {
  const auto along = line.corners[1] + line.corners[2] - line.corners[0] - line.corners[3];
  const float lean = along.y / along.x * static_cast<float>(line.height) / 2;
  cv::Mat straight;
  double most = 0;
  for (int quarter = 0; quarter <= (std::abs(lean) < 0.5F ? 0 : 4); ++quarter) {
    auto from = line.corners;
    for (std::size_t i = 0; i < 4; ++i)
      from[i] += cv::Point2f((i < 2 ? lean : -lean) * static_cast<float>(quarter) / 4, 0) - shift;
    cv::Mat leaning;
    cv::warpPerspective(grey, leaning, cv::getPerspectiveTransform(from, to), size, cv::INTER_CUBIC,
                        cv::BORDER_REPLICATE);
    if (const double upright = unevenness_of_columns(leaning); upright > most) {
      most = upright;
      straight = leaning;
    }
  }
  return straight;
}

/// Makes the ground white, and the ink black.
cv::Mat even_out(const cv::Mat& straight, int letter_height, double noise) {
  // Closing removes the narrow letters and leaves the ground.
  cv::Mat ground;
  const int reach = letter_height | 1;
  cv::morphologyEx(straight, ground, cv::MORPH_CLOSE,
                   cv::getStructuringElement(cv::MORPH_RECT, {reach, reach}));
  cv::GaussianBlur(ground, ground, {}, letter_height / 4.0);
  cv::Mat even;
  cv::divide(straight, ground, even, 255);
  std::vector<int> counts(256);
  for (int y = 0; y < even.rows; ++y)
    for (int x = 0; x < even.cols; ++x) ++counts[even.at<std::uint8_t>(y, x)];
  int ink = 0, below = counts[0];
  while (below < even.rows * even.cols / 50) below += counts[static_cast<std::size_t>(++ink)];
  const double white = 255 - 3 * noise * 0.4;
  const double stretch = 255 / std::max(16.0, white - ink);
  even.convertTo(even, CV_8U, stretch, -ink * stretch);
  return even;
}

}  // namespace

cv::Mat straighten(const cv::Mat& image, const TextLine& line, int letter_height) {
  const cv::Rect part = part_around(line, image.size());
  if (part.empty()) return {};
  cv::Mat grey = mean_of_channels(image(part));
  if (line.is_bright) grey = 255 - grey;
  const double noise = noise_of(grey);
  if (noise > 4) grey = smooth(grey, 0.7);
  const double scale = letter_height / line.height;
  if (scale < 0.7) grey = smooth(grey, 0.4 / scale);  // before shrinking
  // Room for parts above and below; less at the sides, where the edge of the board may be near.
  const auto high = static_cast<float>(letter_height);
  const auto wide = static_cast<float>(line.width() * scale);
  const float room = 0.6F * high, margin = 0.4F * high;
  const cv::Size size(cvRound(wide + 2 * margin), cvRound(high + 2 * room));
  const std::array<cv::Point2f, 4> to = {
      cv::Point2f(margin, room), cv::Point2f(margin + wide, room),
      cv::Point2f(margin + wide, room + high), cv::Point2f(margin, room + high)};
  const cv::Mat straight = warp_upright(grey, line, cv::Point2f(part.tl()), to, size);
  return even_out(straight, letter_height, noise);
}

}  // namespace hc::vision
