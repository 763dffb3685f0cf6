// SPDX-License-Identifier: Apache-2.0
// augment [--rounds N] [--save FOLDER]: objects drawn into what the simulated head sees, as
// Markdown: speed of both eyes, and how right what hides them is, against rooms in which they
// really stand. Depth is the truth, or what the matcher finds in images with a camera's noise.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include <graphics/occlusion.h>
#include <graphics/overlay.h>
#include <graphics/renderer.h>
#include <room/sensor.h>
#include <room/world.h>
#include <vision/stereo/depth.h>
#include <vision/stereo/matcher.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace {

using hc::graphics::Body, hc::graphics::Overlay, hc::graphics::Renderer;

constexpr double kBaseline = 0.1;  // of the simulated head [m]
const hc::graphics::PinholeCamera kCamera;
const double kScale = kCamera.fx * kBaseline;

void end_if_failed(const hc::Status& status) {
  if (status) return;
  std::fprintf(stderr, "augment: %s\n", status.error().text().c_str());
  std::exit(1);
}

Eigen::Isometry3d left_eye(double pan, double tilt) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translate(Eigen::Vector3d(0, 0, hc::room::kHeadHeight));
  T.rotate(Eigen::AngleAxisd(pan, Eigen::Vector3d::UnitZ()) *
           Eigen::AngleAxisd(tilt, Eigen::Vector3d::UnitY()));
  T.translate(Eigen::Vector3d(0.06, kBaseline / 2, 0.05));
  Eigen::Matrix3d optical;
  optical << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  T.rotate(optical);
  return T;
}

Body make_cube(Renderer& renderer, double size) {
  cv::Mat squares(8, 8, CV_8UC3);
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 8; ++x)
      squares.at<cv::Vec3b>(y, x) = (x + y) % 2 == 0 ? cv::Vec3b(250, 200, 40) : cv::Vec3b(40, 60, 200);
  cv::resize(squares, squares, {256, 256}, 0, 0, cv::INTER_NEAREST);
  return hc::graphics::make_body(renderer, {{hc::graphics::make_box({1, 1, 1}), squares}}, size);
}

/// What both eyes see.
struct Seen {
  cv::Mat left, right;              // (H, W, 3) u8
  cv::Mat left_truth, right_truth;  // depth (H, W) f32 [m]
  cv::Mat found;                    // depth (H, W) f32 [m]
};

Seen look(Renderer& renderer, hc::room::World& world, const Eigen::Vector3d& ball,
          const Eigen::Isometry3d& T_world_left, std::uint64_t number) {
  Seen seen;
  const auto& items = world.items(ball);
  const Eigen::Isometry3d T_world_right = T_world_left * Eigen::Translation3d(kBaseline, 0, 0);
  end_if_failed(renderer.draw(items, kCamera, T_world_left, world.light(), seen.left, &seen.left_truth));
  end_if_failed(renderer.draw(items, kCamera, T_world_right, world.light(), seen.right, &seen.right_truth));
  hc::room::Sensor(1).apply(seen.left, 0, 2, number);
  hc::room::Sensor(2).apply(seen.right, 0, 2, number);
  static const auto matcher = hc::vision::semi_global_matcher({.disparities = 64});
  hc::vision::Disparities disparities;
  end_if_failed(matcher->match(seen.left, seen.right, disparities));
  hc::vision::depth_of(disparities.disparity, {.focal = kCamera.fx, .baseline = kBaseline}, seen.found);
  return seen;
}

double milliseconds(const std::function<void()>& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

struct Augmented {
  cv::Mat image, mask;
};

Augmented augment(Overlay& overlay, const Body& body, const Eigen::Isometry3d& T_world_eye,
                  const hc::graphics::Light& light, const cv::Mat& image, const cv::Mat& depth, bool is_right) {
  Augmented result{image.clone(), cv::Mat::zeros(image.size(), CV_8U)};
  const Overlay::View view{kCamera, T_world_eye, light, kScale, [&](const cv::Rect& part, cv::Mat& nearness) {
    (is_right ? hc::graphics::nearness_of_right : hc::graphics::nearness_of_left)(depth, kScale, part, nearness);
  }};
  end_if_failed(overlay.draw({&body, 1}, view, result.image, &result.mask));
  return result;
}

}  // namespace

int main(int argc, char** argv) {
  int rounds = 9;
  std::string folder;
  for (int i = 1; i + 1 < argc; i += 2)
    if (std::string(argv[i]) == "--rounds") rounds = std::atoi(argv[i + 1]);
    else folder = argv[i + 1];
  auto made = Renderer::make();
  if (!made) end_if_failed(made.error());
  Renderer& renderer = **made;
  Overlay overlay(renderer);
  for (int number = 1; number <= 5; ++number) {
    hc::room::World world(renderer, static_cast<std::uint64_t>(number), "HELLO");
    Body cube = make_cube(renderer, 0.3);
    cube.T_world_body = Eigen::Translation3d(2.75, 0.35, 0.6) * Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitZ());
    const auto T = left_eye(0.1, 0.2);
    const auto T_right = T * Eigen::Translation3d(kBaseline, 0, 0);
    const auto seen = look(renderer, world, {2.38, 0.2, 0.65}, T, 1);
    for (bool truth : {true, false}) for (bool is_right : {false, true}) {
      const auto result = augment(overlay, cube, is_right ? T_right : T, world.light(), is_right ? seen.right : seen.left, truth ? seen.left_truth : seen.found, is_right);
      // truth
      cv::Mat rgba, depth;
      end_if_failed(renderer.draw_part({{ hc::graphics::Item{cube.surfaces[0], cube.T_world_body.cast<float>()}}}, kCamera, cv::Rect(0,0,800,600), is_right ? T_right : T, world.light(), rgba, depth));
      const cv::Mat& scene = is_right ? seen.right_truth : seen.left_truth;
      int pixels = 0, right = 0, hidden = 0;
      for (int y = 0; y < 600; ++y) for (int x = 0; x < 800; ++x) {
        const float z = depth.at<float>(y, x);
        if (z == 0) continue;
        ++pixels;
        const bool is_seen = z < scene.at<float>(y, x);
        hidden += !is_seen;
        right += is_seen == (result.mask.at<std::uint8_t>(y, x) > 127);
      }
      std::printf("room %d %s %s: %d pixels, %.1f %% hidden, %.2f %% right\n", number, truth ? "truth" : "found", is_right ? "right" : "left", pixels, 100.0*hidden/pixels, 100.0 * right / pixels);
      if (!folder.empty()) {
        cv::Mat bgr; cv::cvtColor(result.image, bgr, cv::COLOR_RGB2BGR);
        cv::imwrite(folder + "/" + std::to_string(number) + (truth ? "t" : "f") + (is_right ? "r" : "l") + ".png", bgr);
      }
    }
    if (number == 1) {
      std::vector<double> times, copies;
      for (int round = 0; round < rounds * 10; ++round) {
        cv::Mat l, r;
        times.push_back(milliseconds([&] {
          l = augment(overlay, cube, T, world.light(), seen.left, seen.found, false).image;
          r = augment(overlay, cube, T_right, world.light(), seen.right, seen.found, true).image;
        }));
      }
      std::printf("both eyes %.2f ms\n", median(times));
    }
  }
}
