// SPDX-License-Identifier: Apache-2.0
// augment [--rounds N] [--save FOLDER]: objects drawn into what the simulated head sees, as
// Markdown: speed of both eyes, and how right what hides them is, against rooms in which they
// stand. Depth is the truth, or what the matcher finds in images with a camera's noise.

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include <graphics/occlusion.h>
#include <graphics/overlay.h>
#include <graphics/renderer.h>
#include <room/world.h>
#include <vision/stereo/depth.h>
#include <vision/stereo/matcher.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "head_sees.h"

namespace {

using hc::graphics::Body, hc::graphics::Overlay, hc::graphics::Renderer;

using bench::Eye, bench::kBaseline, bench::kCamera, bench::median, bench::milliseconds;

const double kScale = kCamera.fx * kBaseline;

Body make_cube(Renderer& renderer, double size) {
  cv::Mat squares(4, 4, CV_8UC3, cv::Scalar(40, 60, 200));
  for (int i = 0; i < 16; ++i)
    if ((i / 4 + i) % 2 == 0) squares.at<cv::Vec3b>(i / 4, i % 4) = cv::Vec3b(250, 200, 40);
  cv::resize(squares, squares, {}, 32, 32, cv::INTER_NEAREST);
  Body cube = hc::graphics::make_body(renderer, {{hc::graphics::make_box({1, 1, 1}), squares}});
  cube.set_size(size);
  return cube;
}

/// A room, seen by both eyes.
struct View {
  hc::graphics::Light light;
  std::array<Eye, 2> eyes;  // left, right
  cv::Mat found;            // depth of the left image by matching (H, W) f32 [m]
};

View look(Renderer& renderer, hc::room::World& world, int number) {
  View view;
  view.light = world.light();
  const bench::Gaze gaze{
      .pan = 0.1, .tilt = 0.2, .seeds = {2, 1}, .image = static_cast<std::uint64_t>(number)};
  view.eyes = bench::look(renderer, world, {2.38, 0.2, 0.65}, gaze);
  static const auto kMatcher = hc::vision::semi_global_matcher({.disparities = 64});
  hc::vision::Disparities found;
  bench::must(kMatcher->match(view.eyes[0].image, view.eyes[1].image, found));
  hc::vision::depth_of(found.disparity, {.focal = kCamera.fx, .baseline = kBaseline}, view.found);
  return view;
}

void augment(Overlay& overlay, const Body& body, const View& view, std::size_t eye,
             const cv::Mat& depth, cv::Mat& image, cv::Mat* mask) {
  const Overlay::View seen{kCamera, view.eyes.at(eye).T_world_eye, view.light, kScale,
                           [&](const cv::Rect& part, cv::Mat& near) {
                             hc::graphics::nearness_of(eye == 1, depth, kScale, part, near);
                           }};
  bench::must(overlay.draw({&body, 1}, seen, image, mask));
}

/// What is drawn of a body in an image of its own.
cv::Mat mask_of(Overlay& overlay, const Body& body, const View& view, std::size_t eye,
                const cv::Mat& depth, const std::string& file) {
  cv::Mat image = view.eyes.at(eye).image.clone(), mask = cv::Mat::zeros(image.size(), CV_8U);
  augment(overlay, body, view, eye, depth, image, &mask);
  if (!file.empty()) {
    cv::cvtColor(image, image, cv::COLOR_RGB2BGR);
    cv::imwrite(file, image);
  }
  return mask > 127;
}

/// Pixels of a body, and which of them nothing hides, 255 each.
struct Truth {
  cv::Mat body, seen;
};

Truth truth_of(Renderer& renderer, const Body& body, const View& view, std::size_t eye) {
  const Eye& at = view.eyes.at(eye);
  cv::Mat rgb, depth;
  bench::must(renderer.draw(body.items(), kCamera, at.T_world_eye, view.light, rgb, &depth));
  Truth truth;
  truth.body = depth > 0;
  truth.seen = truth.body & (depth < at.truth);
  return truth;
}

double share(const cv::Mat& of, const cv::Mat& all) {
  return static_cast<double>(cv::countNonZero(of)) / cv::countNonZero(all);
}

Body cube_behind_the_bench(Renderer& renderer, double size) {
  Body cube = make_cube(renderer, size);
  cube.T_world_body =
      Eigen::Translation3d(2.75, 0.35, 0.6) * Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitZ());
  return cube;
}

void compare_masks(Renderer& renderer, Overlay& overlay, const std::string& folder) {
  constexpr int kFirst = 11, kRooms = 10, kFrames = 8;  // constants were chosen in rooms 1 to 5
  std::printf(
      "| depth | eye | pixels right, mean of %d rooms | worst room | switch between two frames |\n"
      "|---|---|---:|---:|---:|\n",
      kRooms);
  const Body cube = cube_behind_the_bench(renderer, 0.3);
  struct Case {
    std::string depth, side;
    std::size_t eye;
    double sum = 0, worst = 1, switched = 0, right = 0;
    cv::Mat last = {};
  };
  std::array<Case, 4> cases = {
      {{"true", "left", 0}, {"true", "right", 1}, {"matched", "left", 0}, {"matched", "right", 1}}};
  for (int number = kFirst; number < kFirst + kRooms; ++number) {
    hc::room::World world(renderer, static_cast<std::uint64_t>(number), "HELLO");
    for (int frame = 0; frame < kFrames; ++frame) {
      const View view = look(renderer, world, frame);
      for (Case& each : cases) {
        const std::string name = each.depth + "_" + each.side + "_" + std::to_string(number);
        const cv::Mat mask = mask_of(
            overlay, cube, view, each.eye, each.depth == "true" ? view.eyes[0].truth : view.found,
            folder.empty() || frame > 0 ? "" : folder + "/" + name + ".png");
        const Truth truth = truth_of(renderer, cube, view, each.eye);
        each.right += share((mask == truth.seen) & truth.body, truth.body) / kFrames;
        if (frame > 0)
          each.switched +=
              share((mask != each.last) & truth.body, truth.body) / (kFrames - 1) / kRooms;
        each.last = mask;
      }
    }
    for (Case& each : cases) {
      each.sum += each.right / kRooms;
      each.worst = std::min(each.worst, std::exchange(each.right, 0));
    }
  }
  for (const Case& each : cases)
    std::printf("| %s | %s | %.1f %% | %.1f %% | %.2f %% |\n", each.depth.c_str(),
                each.side.c_str(), 100 * each.sum, 100 * each.worst, 100 * each.switched);
}

void measure_speed(Renderer& renderer, Overlay& overlay, int rounds) {
  std::printf("\n| cube [m] | its part of the image [px] | both eyes [ms] |\n|---|---|---:|\n");
  hc::room::World world(renderer, 1, "HELLO");
  const View view = look(renderer, world, 1);
  for (const double size : {0.3, 0.6, 1.0, 1.4, 2.0, 2.6}) {
    const Body cube = cube_behind_the_bench(renderer, size);
    const cv::Rect part = hc::graphics::part_of(cube, kCamera, view.eyes[0].T_world_eye);
    std::array<cv::Mat, 2> images = {view.eyes[0].image.clone(), view.eyes[1].image.clone()};
    std::vector<double> times;
    times.reserve(static_cast<std::size_t>(rounds));
    for (int round = 0; round < rounds; ++round)
      times.push_back(milliseconds([&] {
        for (const std::size_t eye : {0U, 1U}) {
          view.eyes.at(eye).image.copyTo(images.at(eye));
          augment(overlay, cube, view, eye, view.found, images.at(eye), nullptr);
        }
      }));
    std::printf("| %.1f | %d × %d | %.2f |\n", size, part.width, part.height, median(times));
  }
}

}  // namespace

int main(int argc, char** argv) {
  int rounds = 101;
  std::string folder;
  for (int i = 1; i + 1 < argc; i += 2) {
    if (std::string(argv[i]) == "--rounds") rounds = std::atoi(argv[i + 1]);
    if (std::string(argv[i]) == "--save") folder = argv[i + 1];
  }
  const auto renderer = bench::make_renderer();
  Overlay overlay(*renderer);
  compare_masks(*renderer, overlay, folder);
  measure_speed(*renderer, overlay, std::max(rounds, 1));
}
