// SPDX-License-Identifier: Apache-2.0
#include <vision/stereo/matcher.h>

#include <gtest/gtest.h>

#include <cstdlib>
#include <memory>
#include <string>

#include <vision/image.h>
#include <vision/stereo/score.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace hc::vision {
namespace {

std::string data(const char* name) {
  const char* folder = std::getenv("HC_DATA");
  return std::string(folder == nullptr ? "/usr/share/doc/opencv-doc/examples/data" : folder) + "/" +
         name;
}

struct Pair {
  cv::Mat left, right;
};

/// A random image; its right view is shifted to the left by `shift` pixels.
Pair shifted_pair(cv::Size size, int shift) {
  cv::Mat scene(size.height, size.width + shift, CV_8U);
  cv::RNG(5).fill(scene, cv::RNG::UNIFORM, 0, 255);
  cv::GaussianBlur(scene, scene, {3, 3}, 0);
  return {scene(cv::Rect({0, 0}, size)).clone(), scene(cv::Rect({shift, 0}, size)).clone()};
}

/// Aloe as in graphs/depth.toml; the whole graph must give the same figures (tests/pipes).
struct Aloe {
  Aloe() {
    pair.left = fit(cv::imread(data("aloeL.jpg")), 800, 600);
    pair.right = fit(cv::imread(data("aloeR.jpg")), 800, 600);
    const cv::Mat levels = cv::imread(data("aloeGT.png"), cv::IMREAD_GRAYSCALE);
    fit(levels, 800, 600, false).convertTo(truth, CV_32F, 800.0 / levels.cols);
    cv::cvtColor(pair.left, pair.left, cv::COLOR_BGR2RGB);
    cv::cvtColor(pair.right, pair.right, cv::COLOR_BGR2RGB);
  }
  [[nodiscard]] StereoScore score_of(const cv::Mat& disparity, int from = 0) const {
    const cv::Rect part(from, 0, truth.cols - from, truth.rows);
    return score(disparity(part), truth(part), 2);
  }
  Pair pair;
  cv::Mat truth;
};

class EachMatcher : public testing::TestWithParam<const char*> {
 protected:
  static std::unique_ptr<StereoMatcher> make(const StereoOptions& options) {
    return std::string(GetParam()) == "opencv" ? opencv_matcher(options)
                                               : semi_global_matcher(options);
  }
};

TEST_P(EachMatcher, FindsAShiftThatIsPutIn) {
  const auto [left, right] = shifted_pair({320, 120}, 12);
  Disparities found;
  ASSERT_TRUE(make({.disparities = 64})->match(left, right, found));
  const cv::Rect middle(80, 20, 200, 80);
  EXPECT_NEAR(cv::mean(found.disparity(middle))[0], 12, 0.1) << "px";
  EXPECT_GT(cv::mean(found.confidence(middle))[0], 50);
}

TEST_P(EachMatcher, TakesColourAndGrey) {
  const auto [left, right] = shifted_pair({320, 120}, 12);
  cv::Mat colour;
  cv::cvtColor(left, colour, cv::COLOR_GRAY2RGB);
  Disparities of_grey, of_both;
  ASSERT_TRUE(make({.disparities = 64})->match(left, right, of_grey));
  ASSERT_TRUE(make({.disparities = 64})->match(colour, right, of_both));
  EXPECT_EQ(cv::norm(of_grey.disparity, of_both.disparity, cv::NORM_INF), 0);
}

TEST_P(EachMatcher, SaysWhatItDoesNotTake) {
  const auto matcher = make({.disparities = 64});
  Disparities found;
  const auto error = [&](const cv::Mat& left, const cv::Mat& right) {
    const auto status = matcher->match(left, right, found);
    return status ? std::string() : status.error().detail;
  };
  const cv::Mat image(100, 200, CV_8U, cv::Scalar(9));
  EXPECT_EQ(error(image, cv::Mat()), "the right image is empty");
  EXPECT_EQ(error(image, cv::Mat(100, 201, CV_8U)),
            "the left image is 200 x 100, the right one 201 x 100");
  EXPECT_EQ(error(cv::Mat(100, 200, CV_16U), image),
            "the left image is not u8 with one or three channels");
  EXPECT_EQ(error(image, cv::Mat(100, 200, CV_8UC4)),
            "the right image is not u8 with one or three channels");
  EXPECT_EQ(error(image, image), "") << "without any texture";
}

INSTANTIATE_TEST_SUITE_P(Matchers, EachMatcher, testing::Values("semi_global", "opencv"),
                         [](const auto& each) { return std::string(each.param); });

TEST(SemiGlobalMatcher, DoesNotDependOnTheNumberOfThreads) {
  const Aloe aloe;
  const int before = cv::getNumThreads();
  Disparities first, other;
  cv::setNumThreads(1);
  ASSERT_TRUE(semi_global_matcher({})->match(aloe.pair.left, aloe.pair.right, first));
  for (const int threads : {2, 3, 8}) {
    cv::setNumThreads(threads);
    ASSERT_TRUE(semi_global_matcher({})->match(aloe.pair.left, aloe.pair.right, other));
    EXPECT_EQ(cv::norm(first.disparity, other.disparity, cv::NORM_INF), 0) << threads;
    EXPECT_EQ(cv::norm(first.confidence, other.confidence, cv::NORM_INF), 0) << threads;
  }
  cv::setNumThreads(before);
}

TEST(SemiGlobalMatcher, IsBetterThanOpenCvOnAloe) {
  const Aloe aloe;
  ASSERT_FALSE(aloe.truth.empty());
  Disparities ours, theirs;
  ASSERT_TRUE(semi_global_matcher({})->match(aloe.pair.left, aloe.pair.right, ours));
  ASSERT_TRUE(opencv_matcher({})->match(aloe.pair.left, aloe.pair.right, theirs));
  // OpenCV leaves a band as wide as the disparities empty: exclude it.
  constexpr int kBand = 128;
  const auto our_score = aloe.score_of(ours.disparity, kBand);
  const auto their_score = aloe.score_of(theirs.disparity, kBand);
  EXPECT_LT(our_score.wrong_share(), their_score.wrong_share());
  EXPECT_LT(our_score.bad_share(), their_score.bad_share() + 0.002);
  EXPECT_NEAR(100 * their_score.bad_share(), 2.7, 0.2) << "% of valid pixels, error over 2 px";
}

TEST(SemiGlobalMatcher, IsRightMoreOftenWhereItIsSure) {
  const Aloe aloe;
  Disparities found;
  ASSERT_TRUE(semi_global_matcher({})->match(aloe.pair.left, aloe.pair.right, found));
  const auto bad_share = [&](int least, int most) {
    cv::Mat part;
    found.disparity.copyTo(part, (found.confidence >= least) & (found.confidence <= most));
    return aloe.score_of(part).bad_share();
  };
  const double doubtful = bad_share(1, 15), middle = bad_share(16, 60), sure = bad_share(61, 255);
  EXPECT_GT(doubtful, 2 * middle);
  EXPECT_GT(middle, 2 * sure);
}

}  // namespace
}  // namespace hc::vision
