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

/// A square before a ground that comes nearer from top to bottom, in both eyes.
struct Scene {
  static constexpr int kHeight = 240, kNear = 40;
  static constexpr int kWidth = 400;

  Scene() {
    cv::Mat ground(kHeight, kWidth + kNear, CV_8U), square = ground.clone();
    cv::RNG rng(3);
    for (cv::Mat* texture : {&ground, &square}) {
      rng.fill(*texture, cv::RNG::UNIFORM, 0, 255);
      cv::GaussianBlur(*texture, *texture, {5, 5}, 0);
    }
    for (const bool is_right : {false, true}) {
      cv::Mat across(kHeight, kWidth, CV_32F), down = across.clone(), truth = across.clone();
      cv::Mat on_square = cv::Mat::zeros(across.size(), CV_8U), over;
      for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
          const auto in_left = static_cast<float>(x + (is_right ? kNear : 0));
          const bool is_near = y >= 80 && y < 160 && in_left >= 160 && in_left < 260;
          const float shift = is_near ? kNear : 6 + 0.05F * static_cast<float>(y);
          truth.at<float>(y, x) = shift;
          across.at<float>(y, x) = static_cast<float>(x) + (is_right ? shift : 0);
          down.at<float>(y, x) = static_cast<float>(y);
          on_square.at<std::uint8_t>(y, x) = is_near ? 255 : 0;
        }
      cv::Mat& image = is_right ? pair.right : pair.left;
      cv::remap(ground, image, across, down, cv::INTER_LINEAR);
      cv::remap(square, over, across, down, cv::INTER_LINEAR);
      over.copyTo(image, on_square);
      (is_right ? right_truth : left_truth) = truth;
    }
  }

  Pair pair;
  cv::Mat left_truth, right_truth;  // disparities [px]
};

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

TEST_P(EachMatcher, FindsTheDisparitiesOfBothEyes) {
  const Scene scene;
  Disparities found, of_one;
  const auto matcher = make({.disparities = 64});
  ASSERT_TRUE(matcher->match(scene.pair.left, scene.pair.right, found, Eyes::Both));
  ASSERT_TRUE(matcher->match(scene.pair.left, scene.pair.right, of_one));
  EXPECT_EQ(cv::norm(found.disparity, of_one.disparity, cv::NORM_INF), 0);
  const auto check = [&](const cv::Mat& disparity, const cv::Mat& truth, int from) {
    const cv::Rect part(from, 0, Scene::kWidth - 64, Scene::kHeight);  // without OpenCV's band
    const auto one = score(disparity(part), truth(part), 1);
    EXPECT_LT(100 * one.bad_share(), 1.5) << "% of valid pixels";
    EXPECT_LT(100 * one.hole_share(), 6) << "% of all: also what one eye does not see";
    const cv::Rect on_square(from == 0 ? 130 : 170, 90, 80, 60);
    EXPECT_EQ(score(disparity(on_square), truth(on_square), 0.5).wrong_share(), 0);
  };
  check(found.disparity, scene.left_truth, 64);
  check(found.right, scene.right_truth, 0);
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
  ASSERT_TRUE(matcher->match(image, image, found, Eyes::Both));
  EXPECT_EQ(found.right.size(), image.size());
}

INSTANTIATE_TEST_SUITE_P(Matchers, EachMatcher, testing::Values("semi_global", "opencv"),
                         [](const auto& each) { return std::string(each.param); });

TEST(SemiGlobalMatcher, DoesNotDependOnTheNumberOfThreads) {
  const Aloe aloe;
  const int before = cv::getNumThreads();
  Disparities first, other;
  cv::setNumThreads(1);
  ASSERT_TRUE(semi_global_matcher({})->match(aloe.pair.left, aloe.pair.right, first, Eyes::Both));
  for (const int threads : {2, 3, 8}) {
    cv::setNumThreads(threads);
    ASSERT_TRUE(semi_global_matcher({})->match(aloe.pair.left, aloe.pair.right, other, Eyes::Both));
    EXPECT_EQ(cv::norm(first.right, other.right, cv::NORM_INF), 0) << threads;
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
