// SPDX-License-Identifier: Apache-2.0
#include <vision/stereo/matcher.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include <hc/base/format.h>
#include <vision/image.h>
#include <vision/stereo/semi_global.h>
#include <vision/stereo/smoother.h>
#include <vision/stereo/speckles.h>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

namespace hc::vision {
namespace {

Status check(const cv::Mat& left, const cv::Mat& right) {
  for (const auto* image : {&left, &right}) {
    const char* eye = image == &left ? "left" : "right";
    if (image->empty()) return Error{Code::Invalid, hc::format("the {} image is empty", eye)};
    if (image->depth() != CV_8U || (image->channels() != 1 && image->channels() != 3))
      return Error{Code::Invalid,
                   hc::format("the {} image is not u8 with one or three channels", eye)};
  }
  if (left.size() != right.size())
    return Error{Code::Invalid, hc::format("the left image is {} x {}, the right one {} x {}",
                                           left.cols, left.rows, right.cols, right.rows)};
  return {};
}

/// Intensities of an image for match_rows(), with a border that repeats the outermost pixels.
void prepare(const cv::Mat& image, bool flipped, cv::Mat& bordered) {
  bordered.create(image.rows + 2 * kBorder, image.cols + 2 * kBorder + kReadBeyond, CV_8U);
  cv::Mat inside = bordered(cv::Rect({kBorder, kBorder}, image.size()));
  if (image.channels() == 1)
    image.copyTo(inside);
  else
    cv::cvtColor(image, inside, cv::COLOR_RGB2GRAY);
  if (flipped) cv::flip(inside, inside, 1);
  for (int y = 0; y < image.rows; ++y) {
    auto* row = bordered.ptr(y + kBorder);
    std::memset(row, row[kBorder], kBorder);
    auto* end = row + kBorder + image.cols;
    std::memset(end, end[-1], kBorder + kReadBeyond);
  }
  for (int y = 0; y < kBorder; ++y) {
    bordered.row(kBorder).copyTo(bordered.row(y));
    bordered.row(image.rows + kBorder - 1).copyTo(bordered.row(image.rows + kBorder + y));
  }
}

class SemiGlobalMatcher final : public StereoMatcher {
 public:
  explicit SemiGlobalMatcher(const StereoOptions& options) : speckle_size_(options.speckle_size) {
    matching_.disparities = options.disparities;
  }

  Status match(const cv::Mat& left, const cv::Mat& right, Disparities& found, Eyes eyes) override {
    HC_TRY(check(left, right));
    cv::parallel_for_({0, 2}, [&](const cv::Range& range) {
      for (int i = range.start; i < range.end; ++i)
        prepare(i == 0 ? left : right, i == 1, i == 0 ? left_ : right_);
    });
    raw_.create(left.size(), CV_16U);
    raw_right_.create(left.size(), CV_16U);
    found.confidence.create(left.size(), CV_8U);
    match_stripes({&left_, &right_, left.cols, 0, 0, &raw_, &found.confidence,
                   eyes == Eyes::Both ? &raw_right_ : nullptr});
    clean(raw_, found.disparity);
    if (eyes == Eyes::Both) clean(raw_right_, found.right);
    // The median fills some holes.
    cv::max(found.confidence, 1, found.confidence);
    cv::compare(raw_, 0, known_, cv::CMP_GT);
    cv::bitwise_and(found.confidence, known_, found.confidence);
    return {};
  }

 private:
  /// @param whole  without rows.
  void match_stripes(const Stripe& whole) {
    const auto rows = stripes_of(whole.disparity->rows);
    const auto count = static_cast<int>(rows.size()) - 1;
    scratch_.resize(static_cast<std::size_t>(count));
    cv::parallel_for_(
        {0, count},
        [&](const cv::Range& range) {
          for (auto i = static_cast<std::size_t>(range.start);
               i < static_cast<std::size_t>(range.end); ++i) {
            Stripe stripe = whole;
            stripe.begin = rows[i];
            stripe.end = rows[i + 1];
            match_rows(stripe, matching_, scratch_[i]);
          }
        },
        count);
  }

  /// @param[in,out] raw  of match_rows(); smoothed. @param[out] disparity  [px].
  void clean(cv::Mat& raw, cv::Mat& disparity) {
    constexpr int kMedian = 3;  // side of the window [px]
    cv::medianBlur(raw, clean_, kMedian);
    speckles_.remove(clean_, speckle_size_, kSubPixels);
    smoother_.smooth(clean_, raw);
    raw.convertTo(disparity, CV_32F, 1.0 / kSubPixels);
  }

  SemiGlobal matching_;
  int speckle_size_;
  cv::Mat left_, right_, raw_, raw_right_, clean_, known_;
  std::vector<Scratch> scratch_;
  SpeckleFilter speckles_;
  Smoother smoother_;
};

class OpenCvMatcher final : public StereoMatcher {
 public:
  OpenCvMatcher(const StereoOptions& options, int block_size) {
    // Penalties from OpenCV's documentation for one channel; the rest was tuned on the Aloe pair.
    const int area = block_size * block_size;
    constexpr int kLeast = 0, kLeftRightDifference = 1, kPreFilterCap = 63, kUniqueness = 10;
    constexpr int kSpeckleRange = 2;
    matcher_ =
        cv::StereoSGBM::create(kLeast, options.disparities, block_size, 8 * area, 32 * area,
                               kLeftRightDifference, kPreFilterCap, kUniqueness,
                               options.speckle_size, kSpeckleRange, cv::StereoSGBM::MODE_SGBM_3WAY);
  }

  Status match(const cv::Mat& left, const cv::Mat& right, Disparities& found, Eyes eyes) override {
    HC_TRY(check(left, right));
    // OpenCV 4.6 writes out of bounds otherwise.
    if (left.cols <= matcher_->getNumDisparities())
      return Error{Code::Invalid, hc::format("images of {} x {} are not wider than {} disparities",
                                             left.cols, left.rows, matcher_->getNumDisparities())};
    const cv::Mat grey_left = grey_of(left), grey_right = grey_of(right);
    find(grey_left, grey_right, found.disparity);
    cv::compare(found.disparity, 0.0, found.confidence, cv::CMP_GT);
    if (eyes == Eyes::Left) return {};
    // Mirrored, the right eye is the left one.
    cv::Mat mirrored_left, mirrored_right;
    cv::flip(grey_left, mirrored_right, 1);
    cv::flip(grey_right, mirrored_left, 1);
    find(mirrored_left, mirrored_right, found.right);
    cv::flip(found.right, found.right, 1);
    return {};
  }

 private:
  void find(const cv::Mat& left, const cv::Mat& right, cv::Mat& disparity) {
    constexpr int kScale = cv::StereoMatcher::DISP_SCALE;
    matcher_->compute(left, right, sixteenths_);
    sixteenths_.convertTo(disparity, CV_32F, 1.0 / kScale);
    cv::max(disparity, 0.0, disparity);  // unknown is -1 there, 0 here
  }

  cv::Ptr<cv::StereoSGBM> matcher_;
  cv::Mat sixteenths_;
};

}  // namespace

std::unique_ptr<StereoMatcher> semi_global_matcher(const StereoOptions& options) {
  return std::make_unique<SemiGlobalMatcher>(options);
}

std::unique_ptr<StereoMatcher> opencv_matcher(const StereoOptions& options, int block_size) {
  return std::make_unique<OpenCvMatcher>(options, block_size);
}

}  // namespace hc::vision
