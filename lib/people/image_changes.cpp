// SPDX-License-Identifier: Apache-2.0
#include <people/image_changes.h>

#include <algorithm>
#include <utility>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace hc::people {
namespace {

constexpr int kCoarse = 8;  // pixels of an image in one of its coarse image, each way

}  // namespace

void ImageChanges::add(const cv::Mat& image) {
  const cv::Size size(std::max(1, image.cols / kCoarse), std::max(1, image.rows / kCoarse));
  cv::Mat small, grey;
  cv::resize(image, small, size, 0, 0, cv::INTER_AREA);
  if (small.channels() == 3)
    cv::cvtColor(small, grey, cv::COLOR_RGB2GRAY);
  else
    grey = small;
  const cv::Mat last = std::exchange(last_, grey);
  if (std::exchange(size_, image.size()) != image.size()) {
    sum_ = cv::Mat::zeros(size, CV_32F);
    ages_ = cv::Mat::zeros(size, CV_32F);
    return;
  }
  cv::Mat change;
  cv::absdiff(grey, last, change);
  cv::add(sum_, change, sum_, cv::noArray(), CV_32F);
  cv::add(ages_, 1, ages_);
}

cv::Rect ImageChanges::coarse(const cv::Rect& part) const {
  const cv::Point begin(part.x / kCoarse, part.y / kCoarse);
  const cv::Point end((part.x + part.width + kCoarse - 1) / kCoarse,
                      (part.y + part.height + kCoarse - 1) / kCoarse);
  return cv::Rect(begin, end) & cv::Rect({}, sum_.size());
}

double ImageChanges::change(const cv::Rect& part) const {
  const cv::Rect of = coarse(part);
  return of.empty() ? 0 : cv::mean(sum_(of))[0];
}

double ImageChanges::age(const cv::Rect& part) const {
  const cv::Rect of = coarse(part);
  return of.empty() ? 0 : cv::mean(ages_(of))[0];
}

void ImageChanges::forget_change(const cv::Rect& part) {
  if (const cv::Rect of = coarse(part); !of.empty()) sum_(of) = 0;
}

void ImageChanges::forget_age(const cv::Rect& part) {
  if (const cv::Rect of = coarse(part); !of.empty()) ages_(of) = 0;
}

}  // namespace hc::people
