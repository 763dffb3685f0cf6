// SPDX-License-Identifier: Apache-2.0
#include <room/paint.h>

#include <algorithm>
#include <sstream>
#include <vector>

#include <graphics/text.h>
#include <vision/marker_finder.h>
#include <opencv2/imgproc.hpp>

namespace hc::room {

namespace {

constexpr int kCell = 8;  // of a marker [px]
const cv::Scalar kInk(20, 20, 25);

}  // namespace

cv::Mat paint_grains(int width, int height, const cv::Scalar& rgb, double strength,
                     std::uint64_t seed) {
  cv::RNG random(seed + 1);
  cv::Mat sum(height, width, CV_32F, cv::Scalar(0));
  double weight = 0.5;
  for (int cells : {8, 32, 128, 512}) {
    cv::Mat coarse(std::max(2, std::min(cells, height)), std::max(2, std::min(cells, width)),
                   CV_32F);
    random.fill(coarse, cv::RNG::UNIFORM, -1.0, 1.0);
    cv::Mat fine;
    cv::resize(coarse, fine, sum.size(), 0, 0, cv::INTER_LINEAR);
    sum += weight * fine;
    weight *= 0.8;
  }
  std::vector<cv::Mat> planes(3);
  for (int channel = 0; channel < 3; ++channel)
    sum.convertTo(planes[static_cast<std::size_t>(channel)], CV_8U, strength, rgb[channel]);
  cv::Mat image;
  cv::merge(planes, image);
  return image;
}

cv::Mat paint_planks(int width, int height, std::uint64_t seed) {
  cv::RNG random(seed + 2);
  cv::Mat image = paint_grains(width, height, {150, 128, 104}, 18, seed);
  cv::resize(image(cv::Rect(0, 0, width / 8, height)), image, {width, height});
  const int plank = std::max(4, height / 12);
  for (int y = 0; y < height; y += plank) {
    cv::Mat row = image(cv::Rect(0, y, width, std::min(plank, height - y)));
    row += cv::Scalar::all(random.uniform(-22, 22));
    cv::line(image, {0, y}, {width, y}, {70, 60, 50}, 1);
    for (int x = random.uniform(0, width / 2); x < width; x += random.uniform(width / 4, width / 2))
      cv::line(image, {x, y}, {x, std::min(y + plank, height)}, {70, 60, 50}, 1);
  }
  return image;
}

cv::Mat paint_poster(int width, int height, std::uint64_t seed) {
  cv::RNG random(seed + 3);
  cv::Mat image(height, width, CV_8UC3, cv::Scalar(214, 210, 196));
  for (int i = 0; i < 60; ++i) {
    // Greys, blues and ochres of low saturation.
    const int base = random.uniform(40, 200), tint = random.uniform(-25, 25);
    const cv::Scalar colour(base + tint, base, base - tint);
    const int y = random.uniform(0, height), x = random.uniform(0, width);
    const cv::Point a(x, y);
    const int size = random.uniform(width / 30, width / 8);
    if (i % 2 == 0)
      cv::circle(image, a, size, colour, cv::FILLED, cv::LINE_AA);
    else
      cv::rectangle(image, a, a + cv::Point(size, 2 * size), colour, cv::FILLED);
  }
  cv::rectangle(image, {0, 0}, {width - 1, height - 1}, {50, 50, 55}, width / 50 + 1);
  return image;
}

cv::Mat paint_tag(const std::string& dictionary, int id) {
  const cv::Mat inside = dictionary == "aruco"
                             ? vision::ArucoFinder::make("6X6_250").value().cells(id)
                             : vision::apriltag_cells(id);
  cv::Mat cells, image;
  cv::copyMakeBorder(inside, cells, 1, 1, 1, 1, cv::BORDER_CONSTANT, cv::Scalar(0));
  cv::copyMakeBorder(cells, cells, 1, 1, 1, 1, cv::BORDER_CONSTANT, cv::Scalar(255));
  cv::resize(cells, image, {}, kCell, kCell, cv::INTER_NEAREST);
  cv::cvtColor(image, image, cv::COLOR_GRAY2RGB);
  return image;
}

cv::Mat paint_marker(const cv::Scalar& rgb) {
  cv::Mat image(96, 96, CV_8UC3, cv::Scalar(255, 255, 255));
  image(cv::Rect(16, 16, 64, 64)) = rgb;
  return image;
}

cv::Mat paint_board(const std::string& text, int width, int height) {
  cv::Mat image(height, width, CV_8UC3, cv::Scalar(245, 245, 240));
  std::vector<std::string> lines;
  std::string line;
  for (std::istringstream all(text); std::getline(all, line);) lines.push_back(line);
  const auto pen = graphics::pen_for(text, kInk);
  const int margin = width / 20;
  const int room = (height - 2 * margin) / std::max(1, static_cast<int>(lines.size()));
  double scale = 1e9;
  int below = 0;
  for (const auto& each : lines) {
    const auto size = pen.measure(each, 10, 1, below);
    if (size.width > 0) scale = std::min(scale, 10.0 * (width - 2 * margin) / size.width);
    scale = std::min(scale, 10.0 * 0.8 * room / (size.height + below));
  }
  int top = margin;
  for (const auto& each : lines) {
    const int stroke = std::max(1, static_cast<int>(2.6 * scale));
    const auto size = pen.measure(each, scale, stroke, below);
    pen.write(image, each, {(width - size.width) / 2, top + (room + size.height) / 2}, scale,
              stroke);
    top += room;
  }
  return image;
}

}  // namespace hc::room
