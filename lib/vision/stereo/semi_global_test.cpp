// SPDX-License-Identifier: Apache-2.0
#include <vision/stereo/semi_global.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <string>
#include <vector>

#include <hc/testing/vectors.h>
#include <opencv2/imgproc.hpp>

namespace hc::vision {
namespace {

/// Scalar reference implementation.
class Plain {
 public:
  Plain(const cv::Mat& left, const cv::Mat& right, const SemiGlobal& options)
      : left_(left), right_(right), options_(options), count_(options.disparities) {}

  void run(cv::Mat& disparity, cv::Mat& margin, cv::Mat& right_disparity) {
    disparity.create(left_.size(), CV_16U);
    margin.create(left_.size(), CV_8U);
    right_disparity.create(left_.size(), CV_16U);
    const auto begins = stripes_of(left_.rows);
    for (std::size_t i = 0; i + 1 < begins.size(); ++i) {
      paths_.assign(4, Row(static_cast<std::size_t>(left_.cols), Costs()));
      for (int y = std::max(0, begins[i] - kWarmUpRows); y < begins[i + 1]; ++y) {
        const auto sums = match_row(y);
        std::vector<Winner> winners;
        for (const Costs& sum : sums) winners.push_back(winner(sum));
        if (y < begins[i]) continue;
        write(y, winners, disparity, margin);
        write_right(y, sums, winners, right_disparity);
      }
    }
  }

 private:
  using Costs = std::vector<int>;  // by disparity; empty: none
  using Row = std::vector<Costs>;  // by column
  struct Winner {
    int disparity, cost, margin, fraction;
  };
  static constexpr int kMost = 255, kOutside = 8;

  static int grey(const cv::Mat& image, int y, int x) {
    return image.at<std::uint8_t>(std::clamp(y, 0, image.rows - 1),
                                  std::clamp(x, 0, image.cols - 1));
  }

  static int mean(const cv::Mat& image, int y, int x) {
    const auto of = [](int a, int b) { return (a + b + 1) / 2; };
    return of(of(grey(image, y, x - 1), grey(image, y, x + 1)),
              of(grey(image, y - 1, x), grey(image, y + 1, x)));
  }

  int matching_cost(int y, int x, int disparity) const {
    const int partner = x - disparity;
    if (partner < 0) return kOutside;
    int different = 0;
    for (const auto& [dy, dx] : kCensus)
      different += (grey(left_, y + dy, x + dx) < mean(left_, y, x)) !=
                   (grey(right_, y + dy, partner + dx) < mean(right_, y, partner));
    return different;
  }

  Costs arrive(const Costs& costs, const Costs& from, int step) const {
    const int jump = options_.penalties.jump[static_cast<std::size_t>(std::abs(step))];
    Costs to(costs);
    for (int d = 0; d < count_; ++d) {
      const auto at = static_cast<std::size_t>(d);
      int way = 0;
      if (!from.empty()) {
        way = std::min(from[at], jump);
        if (d > 0) way = std::min(way, from[at - 1] + options_.penalties.slope);
        if (d + 1 < count_) way = std::min(way, from[at + 1] + options_.penalties.slope);
      }
      to[at] = std::min(kMost, to[at] + way);
    }
    const int min = *std::min_element(to.begin(), to.end());
    for (int& cost : to) cost -= min;
    return to;
  }

  /// The sums of the path costs.
  Row match_row(int y) {
    const int width = left_.cols;
    Row costs, sums(static_cast<std::size_t>(width), Costs(static_cast<std::size_t>(count_)));
    for (int x = 0; x < width; ++x) {
      costs.emplace_back();
      for (int d = 0; d < count_; ++d) costs.back().push_back(matching_cost(y, x, d));
    }
    const auto add = [&](int x, const Costs& path) {
      for (std::size_t d = 0; d < path.size(); ++d) {
        int& sum = sums[static_cast<std::size_t>(x)][d];
        sum = std::min(kMost, sum + path[d]);
      }
    };
    for (int direction = -1; direction <= 1; ++direction) {  // from the row above
      Row& path = paths_[static_cast<std::size_t>(direction + 1)];
      Row next;
      for (int x = 0; x < width; ++x) {
        const int from = x + direction;
        const bool inside = from >= 0 && from < width;
        next.push_back(arrive(costs[static_cast<std::size_t>(x)],
                              inside ? path[static_cast<std::size_t>(from)] : Costs(),
                              grey(left_, y, x) - grey(left_, y - 1, from)));
        add(x, next.back());
      }
      path = next;
    }
    Costs path;
    for (int x = 0; x < width; ++x)
      add(x, path = arrive(costs[static_cast<std::size_t>(x)], path,
                           grey(left_, y, x) - grey(left_, y, x - 1)));
    path.clear();
    for (int x = width - 1; x >= 0; --x)
      add(x, path = arrive(costs[static_cast<std::size_t>(x)], path,
                           grey(left_, y, x) - grey(left_, y, x + 1)));
    return sums;
  }

  Winner winner(const Costs& sum) const {
    const auto best = std::min_element(sum.begin(), sum.end());
    Winner found{static_cast<int>(best - sum.begin()), *best, 0, 0};
    int other = kMost;
    for (int d = 0; d < count_; ++d)
      if (std::abs(d - found.disparity) > 1)
        other = std::min(other, sum[static_cast<std::size_t>(d)]);
    found.margin = other - found.cost;
    if (found.disparity == 0 || found.disparity == count_ - 1) return found;
    const int below = best[-1], above = best[1], rise = std::max(below, above) - *best;
    if (rise > 0 && std::max(below, above) < kMost)
      found.fraction = (below - above) * (kSubPixels / 2) / rise;
    return found;
  }

  static std::uint16_t in_fixed_point(const Winner& winner) {
    return static_cast<std::uint16_t>(std::max(1, winner.disparity * kSubPixels + winner.fraction));
  }

  bool is_usable(const Winner& winner, int x) const {
    return winner.margin >= options_.margin && winner.disparity <= x && winner.cost < kMost;
  }

  void write_right(int y, const Row& sums, const std::vector<Winner>& winners,
                   cv::Mat& disparity) const {
    for (int x = 0; x < left_.cols; ++x) {
      // The costs of the pixel's partners, which are on a diagonal.
      Costs costs;
      for (int d = 0; d < count_ && x + d < left_.cols; ++d)
        costs.push_back(sums[static_cast<std::size_t>(x + d)][static_cast<std::size_t>(d)]);
      const auto best = std::min_element(costs.begin(), costs.end());
      const auto own = static_cast<int>(best - costs.begin());
      const Winner& partner = winners[static_cast<std::size_t>(x + own)];
      const bool is_known =
          is_usable(partner, x + own) && std::abs(partner.disparity - own) <= options_.left_right;
      disparity.at<std::uint16_t>(y, x) = is_known ? in_fixed_point(partner) : std::uint16_t{0};
    }
  }

  void write(int y, const std::vector<Winner>& winners, cv::Mat& disparity, cv::Mat& margin) const {
    const auto usable = [&](int x) { return is_usable(winners[static_cast<std::size_t>(x)], x); };
    std::vector<int> best(winners.size(), kMost), partner_disparity(winners.size());
    for (int x = 0; x < left_.cols; ++x) {
      const Winner& w = winners[static_cast<std::size_t>(x)];
      if (!usable(x)) continue;
      const auto partner = static_cast<std::size_t>(x - w.disparity);
      if (w.cost >= best[partner]) continue;
      best[partner] = w.cost;
      partner_disparity[partner] = w.disparity;
    }
    for (int x = 0; x < left_.cols; ++x) {
      const Winner& w = winners[static_cast<std::size_t>(x)];
      bool is_known =
          usable(x) && std::abs(partner_disparity[static_cast<std::size_t>(x - w.disparity)] -
                                w.disparity) <= options_.left_right;
      disparity.at<std::uint16_t>(y, x) = is_known ? in_fixed_point(w) : std::uint16_t{0};
      margin.at<std::uint8_t>(y, x) = static_cast<std::uint8_t>(is_known ? w.margin : 0);
    }
  }

  const cv::Mat &left_, &right_;
  const SemiGlobal& options_;
  const int count_;
  std::vector<Row> paths_;  // from the row above, by direction
};

/// Two noisy views of a random scene with two depths.
void draw_pair(cv::Size size, int near, int far, std::uint64_t seed, cv::Mat& left,
               cv::Mat& right) {
  cv::RNG rng(seed);
  cv::Mat scene(size.height, size.width + near, CV_8U);
  rng.fill(scene, cv::RNG::UNIFORM, 0, 256);
  cv::GaussianBlur(scene, scene, {3, 3}, 0);
  scene(cv::Rect({0, 0}, size)).copyTo(left);
  right.create(size, CV_8U);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) {
      const int shift = y < size.height / 2 ? near : far;
      right.at<std::uint8_t>(y, x) = scene.at<std::uint8_t>(y, x + shift);
    }
  cv::Mat noise(size, CV_16S), noisy;
  for (cv::Mat* image : {&left, &right}) {
    rng.fill(noise, cv::RNG::NORMAL, 0, 5);
    image->convertTo(noisy, CV_16S);
    noisy += noise;
    noisy.convertTo(*image, CV_8U);
  }
}

void match(const cv::Mat& left, const cv::Mat& right, const SemiGlobal& options, cv::Mat& disparity,
           cv::Mat& margin, cv::Mat* right_disparity) {
  cv::Mat flipped, padded[2];
  cv::flip(right, flipped, 1);
  for (int i = 0; i < 2; ++i)
    cv::copyMakeBorder(i == 0 ? left : flipped, padded[i], kBorder, kBorder, kBorder,
                       kBorder + kReadBeyond, cv::BORDER_REPLICATE);
  disparity.create(left.size(), CV_16U);
  margin.create(left.size(), CV_8U);
  if (right_disparity != nullptr) right_disparity->create(left.size(), CV_16U);
  const auto begins = stripes_of(left.rows);
  Scratch scratch;
  for (std::size_t i = 0; i + 1 < begins.size(); ++i)
    match_rows({&padded[0], &padded[1], left.cols, begins[i], begins[i + 1], &disparity, &margin,
                right_disparity},
               options, scratch);
}

class SemiGlobalOf : public TestOfVectors {};

TEST_P(SemiGlobalOf, IsThePlainOneBitByBit) {
  struct Case {
    int width, height, disparities;
  };
  for (const Case& c : {Case{97, 45, 16},
                        {64, 40, 32},
                        {131, 64, 48},
                        {150, 33, 64},
                        {70, 20, 128},
                        {140, 37, 128},
                        {160, 12, 80},
                        {200, 10, 176},
                        {260, 9, 256},
                        {1, 1, 16},
                        {3, 2, 16},
                        {1, 90, 32},
                        {90, 1, 64},
                        {40, 300, 16}}) {
    SCOPED_TRACE(std::to_string(c.width) + " x " + std::to_string(c.height) + ", " +
                 std::to_string(c.disparities));
    cv::Mat left, right;
    draw_pair({c.width, c.height}, std::min(c.width, c.disparities) / 2, 3, 7, left, right);
    SemiGlobal options;
    options.disparities = c.disparities;
    cv::Mat plain[3], both[3], one[2];  // disparity, margin, disparity of the right eye
    Plain(left, right, options).run(plain[0], plain[1], plain[2]);
    match(left, right, options, both[0], both[1], &both[2]);
    for (int i = 0; i < 3; ++i) EXPECT_EQ(cv::norm(both[i], plain[i], cv::NORM_INF), 0) << i;
    match(left, right, options, one[0], one[1], nullptr);
    for (int i = 0; i < 2; ++i) EXPECT_EQ(cv::norm(one[i], plain[i], cv::NORM_INF), 0) << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Vectors, SemiGlobalOf, each_kind_of_vectors(), name_of_vectors);

}  // namespace
}  // namespace hc::vision
