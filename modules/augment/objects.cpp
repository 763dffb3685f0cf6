// SPDX-License-Identifier: Apache-2.0
#include "objects.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <frames/rigid.h>
#include <hc/base/text.h>
#include <hc/base/words.h>
#include <opencv2/imgproc.hpp>

namespace {

constexpr double kFarthest = 1e4;  // [m], [degree]

bool read_number(std::string_view word, double& number) {
  return hc::read_number(word, number) && std::abs(number) <= kFarthest;
}

std::optional<NamedFrame> read_frame(std::string_view word) {
  if (word.find_first_not_of("0123456789") != word.npos) return NamedFrame{std::string(word)};
  double number = 0;
  if (!read_number(word, number) || number < 1 || number > 999) return std::nullopt;
  return NamedFrame{std::string(word), static_cast<int>(number)};
}

hc::Result<Object> read_object(std::string_view text) {
  auto wrong = [&](const char* why) {
    return hc::Error{hc::Code::Invalid, "objects: \"" + std::string(text) + "\" " + why};
  };
  // A name with spaces or semicolons is in quotes.
  std::string_view quoted, rest = text;
  if (rest.remove_prefix(std::min(rest.find_first_not_of(" \t\n"), rest.size()));
      rest.starts_with('"')) {
    quoted = rest.substr(1, rest.find('"', 1) - 1);
    rest.remove_prefix(quoted.size() + 2);
  }
  auto all = hc::words_of(rest);
  if (!quoted.empty()) all.insert(all.begin(), quoted);
  if (all.size() < 3 || all[1] != "at") return wrong("is not like cube at world 2 0 0.8 size 0.3");
  Object object;
  object.model = all[0];
  constexpr const char* kWrongFrame = "has a frame number outside 1 to 999";
  const auto frame = read_frame(all[2]);
  if (!frame) return wrong(kWrongFrame);
  object.frame = *frame;
  std::size_t first = 3;  // word of the place
  if (all.size() >= 5 && all[3] == "to") {
    object.other = read_frame(all[4]);
    if (!object.other) return wrong(kWrongFrame);
    first = 5;
  }
  if (all.size() >= first + 2 && all[all.size() - 2] == "size") {
    object.fits = object.other && all.back() == "fit";
    if (!object.fits && (!read_number(all.back(), object.size) || object.size <= 0))
      return wrong("has a size that is neither a positive number [m] nor fit between two frames");
    all.resize(all.size() - 2);
  }
  std::vector<double> numbers;
  for (std::size_t i = first; i < all.size(); ++i) {
    double number = 0;
    if (!read_number(all[i], number)) return wrong("has a position that is not numeric");
    numbers.push_back(number);
  }
  if (!numbers.empty() && numbers.size() != 3 && numbers.size() != 6)
    return wrong("has a position that is neither x y z nor x y z roll pitch yaw");
  numbers.resize(6);
  constexpr double kDegree = std::numbers::pi / 180;
  object.T_frame_object =
      Eigen::Translation3d(numbers[0], numbers[1], numbers[2]) *
      hc::frames::rotation(kDegree * numbers[3], kDegree * numbers[4], kDegree * numbers[5]);
  return object;
}

/// A chequered texture, which makes the orientation of a surface visible.
cv::Mat paint_squares(int columns, int rows, const cv::Vec3b& one, const cv::Vec3b& other) {
  cv::Mat squares(rows, columns, CV_8UC3);
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < columns; ++x) squares.at<cv::Vec3b>(y, x) = (x + y) % 2 == 0 ? one : other;
  constexpr int kPixels = 32;
  cv::resize(squares, squares, {}, kPixels, kPixels, cv::INTER_NEAREST);
  return squares;
}

}  // namespace

hc::Result<std::vector<Object>> read_objects(std::string_view text) {
  std::vector<Object> objects;
  while (!text.empty()) {
    std::size_t end = 0;
    for (bool is_quoted = false; end < text.size() && (is_quoted || text[end] != ';'); ++end)
      if (text[end] == '"') is_quoted = !is_quoted;
    const auto one = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (hc::words_of(one).empty()) continue;
    if (std::ranges::count(one, '"') % 2 != 0)
      return hc::Error{hc::Code::Invalid, "objects: " + std::string(one) + ": a quote has no end"};
    auto object = HC_TRY(read_object(one));
    objects.push_back(std::move(object));
  }
  return objects;
}

Eigen::Isometry3d between_points(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  constexpr double kUpright = 1e-6;  // below, the y axis is only rounding noise
  const Eigen::Vector3d x = (to - from).normalized();
  Eigen::Vector3d y = Eigen::Vector3d::UnitZ().cross(x);
  if (y.norm() < kUpright) y = Eigen::Vector3d::UnitY();
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translation() = (from + to) / 2;
  T.linear().col(2) = x.cross(y).normalized();
  T.linear().col(1) = T.linear().col(2).cross(x);
  T.linear().col(0) = x;
  return T;
}

hc::Result<std::vector<hc::graphics::Part>> load(const std::string& model) {
  using hc::graphics::Part;
  const cv::Vec3b yellow(250, 205, 50), blue(35, 65, 200), green(60, 190, 90), white(240, 240, 235);
  if (model == "cube")
    return std::vector<Part>{
        {hc::graphics::make_box({1, 1, 1}), paint_squares(4, 4, yellow, blue)}};
  if (model == "ball")
    return std::vector<Part>{{hc::graphics::make_ball(0.5F), paint_squares(12, 6, green, white)}};
  auto parts = hc::graphics::read_model(model);
  if (parts || parts.error().code != hc::Code::NotFound) return parts;
  return hc::Error{hc::Code::Invalid, parts.error().detail};  // a restart would not find it either
}
