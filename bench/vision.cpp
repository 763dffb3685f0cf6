// SPDX-License-Identifier: Apache-2.0
// vision [--rounds N]: quality and, unless N is 0, speed of stereo matching beside OpenCV's
// matchers, on the Aloe pair and on rooms that are drawn with exact depth, as Markdown.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <Eigen/Dense>

#include <room/room.h>
#include <vision/image.h>
#include <vision/stereo/depth.h>
#include <vision/stereo/matcher.h>
#include <vision/stereo/score.h>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "head_sees.h"

namespace {

using bench::kBaseline, bench::kCamera, bench::median, bench::milliseconds;
using hc::vision::Disparities, hc::vision::Eyes, hc::vision::StereoMatcher;

struct Pair {
  cv::Mat left, right;  // (H, W, 3) u8, red, green, blue
  cv::Mat truth;        // disparity (H, W) f32 [px], 0 unknown
  cv::Mat right_truth;  // the same of the right image; or empty
  cv::Mat walls;        // (H, W) u8, 255 on the four walls; or empty
};

cv::Mat read_image(const char* name, int flags) {
  const char* folder = std::getenv("HC_DATA");
  return cv::imread(
      std::string(folder == nullptr ? "/usr/share/doc/opencv-doc/examples/data" : folder) + "/" +
          name,
      flags);
}

Pair read_aloe() {
  Pair pair;
  pair.left = hc::vision::fit(read_image("aloeL.jpg", cv::IMREAD_COLOR), 800, 600);
  pair.right = hc::vision::fit(read_image("aloeR.jpg", cv::IMREAD_COLOR), 800, 600);
  for (cv::Mat* image : {&pair.left, &pair.right}) cv::cvtColor(*image, *image, cv::COLOR_BGR2RGB);
  const cv::Mat levels = read_image("aloeGT.png", cv::IMREAD_GRAYSCALE);
  hc::vision::fit(levels, 800, 600, false).convertTo(pair.truth, CV_32F, 800.0 / levels.cols);
  return pair;
}

constexpr int kRooms = 10;
const double kFocal = kCamera.fx;

/// What the simulated head sees, looking somewhere in a room of its own.
Pair draw_room(hc::graphics::Renderer& renderer, int number) {
  hc::room::World world(renderer, static_cast<std::uint64_t>(number), "HELLO");
  const auto seed = 2 * static_cast<std::uint64_t>(number);
  const bench::Gaze gaze{
      .pan = 0.25 * (number - 5), .tilt = 0.12 * (number % 3), .seeds = {seed, seed + 1}};
  const auto [left, right] = bench::look(renderer, world, {2.2, 0.3, 0.65}, gaze);
  const cv::Mat& depth = left.truth;
  Pair pair;
  pair.left = left.image;
  pair.right = right.image;
  // Both ways the same: disparity = focal · baseline / depth, and 0 stays unknown.
  const hc::vision::StereoGeometry geometry{.focal = kFocal, .baseline = kBaseline};
  hc::vision::depth_of(left.truth, geometry, pair.truth);
  hc::vision::depth_of(right.truth, geometry, pair.right_truth);
  pair.walls.create(depth.size(), CV_8U);
  for (int y = 0; y < depth.rows; ++y)
    for (int x = 0; x < depth.cols; ++x) {
      const double z = depth.at<float>(y, x);
      const Eigen::Vector3d p =
          left.T_world_eye *
          Eigen::Vector3d((x - kCamera.cx) * z / kCamera.fx, (y - kCamera.cy) * z / kCamera.fy, z);
      using namespace hc::room;
      const double away = std::min({std::abs(p.x() - kRoomFront), std::abs(p.x() - kRoomBack),
                                    std::abs(std::abs(p.y()) - kRoomSide)});
      constexpr double kThick = 0.02;  // posters and marks hang before the walls [m]
      pair.walls.at<std::uint8_t>(y, x) = z > 0 && away < kThick ? 255 : 0;
    }
  return pair;
}

/// A pair of 1/n of the size, with the disparities of its pixels.
Pair smaller(const Pair& pair, int n) {
  Pair small;
  const cv::Size size = pair.truth.size() / n;
  cv::resize(pair.left, small.left, size, 0, 0, cv::INTER_AREA);
  cv::resize(pair.right, small.right, size, 0, 0, cv::INTER_AREA);
  cv::resize(pair.truth, small.truth, size, 0, 0, cv::INTER_NEAREST);
  small.truth /= n;
  return small;
}

struct Contestant {
  std::string name;
  std::function<void(const Pair&, Disparities&)> match;
};

Contestant ours(const char* name, int disparities, Eyes eyes) {
  const std::shared_ptr<StereoMatcher> matcher =
      hc::vision::semi_global_matcher({.disparities = disparities});
  return {name, [matcher, eyes](const Pair& pair, Disparities& found) {
            if (auto matched = matcher->match(pair.left, pair.right, found, eyes); !matched)
              std::abort();
          }};
}

std::vector<Contestant> contestants(int disparities) {
  const auto theirs = [](const cv::Ptr<cv::StereoMatcher>& matcher) {
    return [matcher](const Pair& pair, Disparities& found) {
      cv::Mat sixteenths;
      matcher->compute(hc::vision::grey_of(pair.left), hc::vision::grey_of(pair.right), sixteenths);
      sixteenths.convertTo(found.disparity, CV_32F, 1.0 / 16);
      cv::max(found.disparity, 0.0, found.disparity);
    };
  };
  const auto sgbm = [&](int mode) {
    return theirs(cv::StereoSGBM::create(0, disparities, 5, 200, 800, 1, 63, 10, 100, 2, mode));
  };
  const auto bm = cv::StereoBM::create(disparities, 15);
  bm->setSpeckleWindowSize(100);
  bm->setSpeckleRange(2);
  bm->setDisp12MaxDiff(1);
  return {ours("semi_global", disparities, Eyes::Left),
          {"OpenCV 3WAY", sgbm(cv::StereoSGBM::MODE_SGBM_3WAY)},
          {"OpenCV SGBM", sgbm(cv::StereoSGBM::MODE_SGBM)},
          {"OpenCV HH4", sgbm(cv::StereoSGBM::MODE_HH4)},
          {"OpenCV BM", theirs(bm)}};
}

cv::Mat right_of(const cv::Mat& image, int column) {
  return image(cv::Rect(column, 0, image.cols - column, image.rows));
}

/// As many matchers as cores, each on one core: a reference for what more cores give, which is less
/// than their number where a machine shares them with others.
class Crowd {
 public:
  explicit Crowd(int disparities) : found_(static_cast<std::size_t>(cv::getNumberOfCPUs())) {
    for (std::size_t i = 0; i < found_.size(); ++i)
      matchers_.push_back(hc::vision::semi_global_matcher({.disparities = disparities}));
  }

  void match(const Pair& pair) {
    cv::setNumThreads(1);
    std::vector<std::jthread> threads;
    for (std::size_t i = 0; i < found_.size(); ++i)
      threads.emplace_back([&, i] {
        if (!matchers_[i]->match(pair.left, pair.right, found_[i])) std::abort();
      });
  }

  [[nodiscard]] double size() const { return static_cast<double>(found_.size()); }

 private:
  std::vector<std::unique_ptr<StereoMatcher>> matchers_;
  std::vector<Disparities> found_;
};

void compare_speed(const Pair& pair, int rounds) {
  std::printf(
      "| disparities | matcher | one core [ms] | all cores [ms] | speed-up | against 3WAY |\n"
      "|---|---|---:|---:|---:|---:|\n");
  const int cores = cv::getNumberOfCPUs();
  for (const int disparities : {64, 128}) {
    auto all = contestants(disparities);
    all.push_back(ours("semi_global, both eyes", disparities, Eyes::Both));
    std::vector<std::vector<double>> one(all.size()), many(all.size());
    std::vector<double> together;
    Crowd crowd(disparities);
    Disparities found;
    for (int round = 0; round <= rounds; ++round) {
      crowd.match(pair);  // caches fill, here and below
      const double crowded = milliseconds([&] { crowd.match(pair); });
      if (round > 0) together.push_back(crowded);
      for (std::size_t i = 0; i < all.size(); ++i)
        for (const bool is_many : {false, true}) {
          cv::setNumThreads(is_many ? cores : 1);
          all[i].match(pair, found);
          const double time = milliseconds([&] { all[i].match(pair, found); });
          if (round > 0) (is_many ? many : one)[i].push_back(time);
        }
    }
    for (std::size_t i = 0; i < all.size(); ++i)
      std::printf("| %d | %s | %.1f | %.1f | %.2f | %.2f × |\n", disparities, all[i].name.c_str(),
                  median(one[i]), median(many[i]), median(one[i]) / median(many[i]),
                  median(many[1]) / median(many[i]));
    std::printf("| %d | the machine: semi_global once on each core | %.1f | %.1f | %.2f | |\n",
                disparities, median(one[0]), median(together),
                crowd.size() * median(one[0]) / median(together));
  }
}

/// How far off depth is, by distance: median and 90th percentile of the error in the drawn rooms.
void print_errors_by_distance(const std::vector<Pair>& pairs, int disparities) {
  std::printf(
      "\n| distance [m] | pixels | error, median [m] | 90 %% below [m] | median [%%] |\n"
      "|---|---:|---:|---:|---:|\n");
  const double bounds[] = {1, 1.5, 2, 2.5, 3, 4, 5, 7};
  std::vector<double> errors[std::size(bounds) - 1];
  const auto matcher = hc::vision::semi_global_matcher({.disparities = disparities});
  for (const Pair& pair : pairs) {
    Disparities found;
    if (!matcher->match(pair.left, pair.right, found)) std::abort();
    cv::Mat depth, true_depth;
    const hc::vision::StereoGeometry geometry{.focal = kFocal, .baseline = kBaseline};
    hc::vision::depth_of(found.disparity, geometry, depth);
    hc::vision::depth_of(pair.truth, geometry, true_depth);
    for (int y = 0; y < depth.rows; ++y)
      for (int x = 0; x < depth.cols; ++x) {
        const double known = true_depth.at<float>(y, x), z = depth.at<float>(y, x);
        for (std::size_t i = 0; z > 0 && i < std::size(errors); ++i)
          if (known >= bounds[i] && known < bounds[i + 1]) errors[i].push_back(std::abs(z - known));
      }
  }
  for (std::size_t i = 0; i < std::size(errors); ++i) {
    auto& all = errors[i];
    if (all.empty()) continue;
    std::sort(all.begin(), all.end());
    const double middle = all[all.size() / 2], high = all[all.size() * 9 / 10];
    std::printf("| %g … %g | %zu | %.3f | %.3f | %.1f |\n", bounds[i], bounds[i + 1], all.size(),
                middle, high, 200 * middle / (bounds[i] + bounds[i + 1]));
  }
}

/// The cost over pixels and disparities: t = a · pixels + b · pixels · disparities.
void fit_cost(const Pair& pair, int rounds) {
  struct Point {
    double pixels, disparities;
    std::vector<double> times;
  };
  std::vector<Point> points;
  std::vector<Pair> images;
  std::vector<std::unique_ptr<StereoMatcher>> matchers;
  for (const cv::Size size : {cv::Size(400, 300), cv::Size(800, 600), cv::Size(1280, 960)})
    for (const int disparities : {64, 128, 192, 256}) {
      Pair scaled;
      cv::resize(pair.left, scaled.left, size);
      cv::resize(pair.right, scaled.right, size);
      images.push_back(scaled);
      matchers.push_back(hc::vision::semi_global_matcher({.disparities = disparities}));
      points.push_back({static_cast<double>(size.area()), static_cast<double>(disparities), {}});
    }
  cv::setNumThreads(cv::getNumberOfCPUs());
  Disparities found;
  for (int round = 0; round <= rounds; ++round)
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double time = milliseconds([&] {
        if (!matchers[i]->match(images[i].left, images[i].right, found)) std::abort();
      });
      if (round > 0) points[i].times.push_back(time);
    }
  Eigen::MatrixXd A(points.size(), 2);
  Eigen::VectorXd t(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    A.row(row) << points[i].pixels * 1e-6, points[i].pixels * points[i].disparities * 1e-6;
    t(row) = median(points[i].times);
  }
  // Each point weighs by its relative error.
  const Eigen::VectorXd weight = t.cwiseInverse();
  const Eigen::VectorXd x =
      (weight.asDiagonal() * A).colPivHouseholderQr().solve(Eigen::VectorXd::Ones(t.size()));
  const double worst = ((A * x - t).cwiseQuotient(t)).cwiseAbs().maxCoeff();
  std::printf(
      "\nt = %.2f ms · Mpx + %.4f ms · Mpx · disparities, all cores; at most %.0f %% off, "
      "from 400 x 300 to 1280 x 960 and 64 to 256 disparities\n",
      x(0), x(1), 100 * worst);
}

void compare_quality(const char* title, const std::vector<Pair>& pairs, int disparities) {
  std::printf(
      "\n%s, %d disparities\n\n| matcher | bad 1 px | bad 2 px | bad 4 px | holes | bad 2 px "
      "or hole | the same right of the band | walls within 0.5 px |\n"
      "|---|---:|---:|---:|---:|---:|---:|---:|\n",
      title, disparities);
  for (auto& contestant : contestants(disparities)) {
    double shares[7] = {};
    for (const Pair& pair : pairs) {
      Disparities found;
      contestant.match(pair, found);
      const auto of = [&](double threshold) {
        return hc::vision::score(found.disparity, pair.truth, threshold);
      };
      const auto two = of(2);
      const auto inside = hc::vision::score(right_of(found.disparity, disparities),
                                            right_of(pair.truth, disparities), 2);
      double walls = 0;
      if (!pair.walls.empty()) {
        cv::Mat on_walls = cv::Mat::zeros(pair.truth.size(), CV_32F);
        pair.truth.copyTo(on_walls, pair.walls);
        const auto half = hc::vision::score(found.disparity, on_walls, 0.5);
        walls = 1 - half.bad_share();
      }
      const double each[] = {of(1).bad_share(),
                             two.bad_share(),
                             of(4).bad_share(),
                             two.hole_share(),
                             two.wrong_share(),
                             inside.wrong_share(),
                             walls};
      for (std::size_t i = 0; i < std::size(each); ++i)
        shares[i] += each[i] / static_cast<double>(pairs.size());
    }
    std::printf("| %s |", contestant.name.c_str());
    for (const double share : shares) std::printf(" %.2f %% |", 100 * share);
    std::printf("\n");
  }
}

/// The disparities of the right eye, which are from the same path costs as those of the left one.
void print_right_eye(const std::vector<Pair>& pairs, int disparities) {
  const auto matcher = ours("", disparities, Eyes::Both);
  double left = 0, right = 0;
  for (const Pair& pair : pairs) {
    Disparities found;
    matcher.match(pair, found);
    left += hc::vision::score(found.disparity, pair.truth, 2).wrong_share();
    right += hc::vision::score(found.right, pair.right_truth, 2).wrong_share();
  }
  const double per_cent = 100 / static_cast<double>(pairs.size());
  std::printf("\nBad 2 px or hole: left eye %.2f %%, right eye %.2f %%\n", left * per_cent,
              right * per_cent);
}

}  // namespace

int main(int argc, char** argv) {
  const int rounds = argc > 2 ? std::atoi(argv[2]) : 9;
  const Pair aloe = read_aloe();
  if (aloe.truth.empty()) {
    std::fprintf(stderr, "vision: no aloeL.jpg, aloeR.jpg, aloeGT.png in HC_DATA\n");
    return 1;
  }
  const auto renderer = bench::make_renderer();
  std::vector<Pair> rooms;
  rooms.reserve(kRooms);
  for (int number = 0; number < kRooms; ++number) rooms.push_back(draw_room(*renderer, number));
  compare_quality("Aloe", {aloe}, 128);
  compare_quality("Ten rooms", rooms, 64);
  std::vector<Pair> small_rooms;
  for (const Pair& room : rooms) small_rooms.push_back(smaller(room, 4));
  compare_quality("Aloe, 1/8 of the size", {smaller(aloe, 8)}, 16);
  compare_quality("Ten rooms, 1/4 of the size", small_rooms, 16);
  print_right_eye(rooms, 64);
  print_errors_by_distance(rooms, 64);
  if (rounds == 0) return 0;
  std::printf("\n");
  compare_speed(aloe, rounds);
  fit_cost(aloe, rounds);
}
