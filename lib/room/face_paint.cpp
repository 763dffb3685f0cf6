// SPDX-License-Identifier: Apache-2.0
#include <room/face_paint.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <Eigen/Geometry>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include <hc/base/check.h>
#include <room/assets.h>
#include <room/face_shape.h>
#include <room/paint.h>

namespace hc::room {

namespace {

using Eigen::Vector2d;

constexpr int kColumns = 512, kRows = 320;  // of the image
constexpr double kPixel = 0.0015;           // of the photograph [m]
const Vector2d kMiddle(80.4, 96.5);         // between its eyes [px]
constexpr double kRoll = 0.042;             // of its face, clockwise [rad]
constexpr double kEyeSide = 0.0315;         // from the middle to an eye [m]

/// What the photograph shows: the colours, and where skin is [0 … 1]; f32.
struct Photograph {
  cv::Mat rgb, skin;
};

Photograph read_photograph() {
  const auto bytes = face_photograph();
  const cv::Mat file(1, static_cast<int>(bytes.size()), CV_8U,
                     const_cast<std::byte*>(bytes.data()));
  cv::Mat image = cv::imdecode(file, cv::IMREAD_COLOR);
  HC_CHECK(!image.empty());
  cv::cvtColor(image, image, cv::COLOR_BGR2RGB);
  // Along the fringe, an ear, the cheek and the chin, and back.
  const std::vector<cv::Point> outline = {
      {42, 72},   {54, 73},   {66, 75},   {80, 76},   {95, 78},   {108, 81},  {120, 83},  {124, 92},
      {126, 105}, {128, 118}, {137, 119}, {134, 128}, {126, 132}, {123, 160}, {105, 185}, {50, 185},
      {40, 150},  {37, 128},  {29, 123},  {27, 113},  {36, 111},  {39, 98}};
  cv::Mat skin(image.size(), CV_8U, cv::Scalar(0));
  cv::fillPoly(skin, std::vector<std::vector<cv::Point>>{outline}, 255);
  cv::GaussianBlur(skin, skin, {}, 1.2);
  Photograph photograph;
  image.convertTo(photograph.rgb, CV_32F, 1 / 255.0);
  skin.convertTo(photograph.skin, CV_32F, 1 / 255.0);
  return photograph;
}

/// Where the photograph shows a place of the face.
cv::Point2f pixel_of(const Vector2d& place) {
  const Eigen::Rotation2D<double> turn(kRoll);
  const Vector2d pixel = kMiddle + turn * Vector2d(place.x(), -place.y()) / kPixel;
  return {static_cast<float>(pixel.x()), static_cast<float>(pixel.y())};
}

/// Where the photographed face has what a look has at a place.
Vector2d unwarped(const Look& look, Vector2d place) {
  const double side = place.x() < 0 ? -1 : 1;
  place.x() *= side;
  std::for_each(look.warps.rbegin(), look.warps.rend(), [&](const auto& warp) {
    const Vector2d from_there = place - warp.middle - warp.move;
    const double weight = std::exp(-from_there.squaredNorm() / (2 * warp.radius * warp.radius));
    const Vector2d was = warp.middle + from_there.cwiseQuotient(warp.enlarge);
    place += weight * (was - place);
  });
  place.x() *= side;
  return place;
}

cv::Vec3f dyed(const cv::Vec3f& colour, const Dye& dye) {
  const float grey = 0.3F * colour[0] + 0.59F * colour[1] + 0.11F * colour[2];
  const double bright = std::pow(std::max(grey, 1e-3F), dye.gamma);
  const double change = bright / std::max(grey, 1e-3F);
  cv::Vec3f result;
  for (int i = 0; i < 3; ++i)
    result[i] = static_cast<float>((1 - dye.strength) * colour[i] * change +
                                   dye.strength * bright * dye.rgb[i]);
  return result;
}

double step(double x, double soft) {
  return 1 / (1 + std::exp(-x / soft));
}

/// How much a beard covers a place, without a look's darkness. 0 … 1
double beard_at(const Vector2d& place) {
  const double y = std::abs(place.x()), z = place.y();
  const double lips = 1 - std::hypot(y / 0.03, (z + 0.068) / 0.0125);
  const double upper = -0.049 - z + std::max(0.0, y - 0.035) * 1.1;  // higher on the cheeks
  return step(upper, 0.002) * (1 - step(lips, 0.08));
}

double brow_at(const Vector2d& place) {
  const double y = std::abs(place.x()) - 0.033, z = place.y() - 0.0165 + 8 * y * y;
  return std::exp(-std::pow(y / 0.0185, 4) - std::pow(z / 0.0035, 2));
}

double glasses_at(const Vector2d& place) {
  constexpr double kThick = 0.0018;
  const double y = std::abs(place.x()), z = place.y() + 0.003;
  const double ring = std::abs(std::hypot((y - kEyeSide) / 1.15, z) - 0.0195);
  const bool is_bridge = y < 0.0095 && std::abs(z - 0.005) < kThick;
  const bool is_temple = y > kEyeSide + 0.0224 && std::abs(z - 0.006) < kThick;
  return is_bridge || is_temple ? 1 : 1 - step(ring - kThick, 0.0004);
}

/// Hair of the back of the head, f32 from 0 to 1.
cv::Mat paint_back(const Look& look) {
  const cv::Vec3f hair = dyed({0.46F, 0.36F, 0.2F}, look.hair);
  cv::Mat grains = paint_grains(kColumns, kRows, {255 * hair[0], 255 * hair[1], 255 * hair[2]}, 30,
                                static_cast<std::uint64_t>(17));
  grains.convertTo(grains, CV_32F, 1 / 255.0);
  return grains;
}

}  // namespace

cv::Scalar skin_of(const Look& look) {
  return 255 * cv::Scalar(dyed({0.83F, 0.66F, 0.54F}, look.skin));
}

cv::Mat paint_head(const Look& look) {
  static const Photograph kPhotograph = read_photograph();
  cv::Mat map(kRows, kColumns, CV_32FC2), places(kRows, kColumns, CV_64FC2);
  for (int row = 0; row < kRows; ++row)
    for (int column = 0; column < kColumns; ++column) {
      const double z = kHeadTop + (kHeadBottom - kHeadTop) * (row + 0.5) / kRows;
      const double round = 2 * std::numbers::pi * ((column + 0.5) / kColumns - 0.5);
      const double y = 0.96 * half_width(z) * std::sin(round);
      const Vector2d place = unwarped(look, {y, z});
      const auto pixel = pixel_of(place);
      map.at<cv::Vec2f>(row, column) = {pixel.x, pixel.y};
      places.at<cv::Vec2d>(row, column) = {place.x(), place.y()};
    }
  cv::Mat rgb, skin, head(kRows, kColumns, CV_8UC3);
  cv::remap(kPhotograph.rgb, rgb, map, {}, cv::INTER_CUBIC, cv::BORDER_REPLICATE);
  cv::remap(kPhotograph.skin, skin, map, {}, cv::INTER_LINEAR, cv::BORDER_REPLICATE);
  const cv::Mat back = paint_back(look);
  const cv::Scalar neck = skin_of(look);
  cv::RNG random(3);
  for (int row = 0; row < kRows; ++row)
    for (int column = 0; column < kColumns; ++column) {
      const auto& at = places.at<cv::Vec2d>(row, column);
      const Vector2d place(at[0], at[1]);
      const double z = kHeadTop + (kHeadBottom - kHeadTop) * (row + 0.5) / kRows;
      const double round = 2 * std::numbers::pi * std::abs((column + 0.5) / kColumns - 0.5);
      const float is_skin = skin.at<float>(row, column);
      cv::Vec3f colour = rgb.at<cv::Vec3f>(row, column);
      colour = is_skin * dyed(colour, look.skin) + (1 - is_skin) * dyed(colour, look.hair);
      const double bristle = 0.75 + 0.25 * random.uniform(0.0, 1.0);
      const double dark = std::max(look.beard * beard_at(place) * is_skin * bristle,
                                   look.brows * brow_at(place) * is_skin);
      colour = (1 - dark) * colour + dark * 0.6 * dyed({0.3F, 0.22F, 0.14F}, look.hair);
      const double y =
          0.96 * half_width(z) * std::sin(2 * std::numbers::pi * ((column + 0.5) / kColumns - 0.5));
      if (look.glasses) colour *= 1 - 0.9 * glasses_at({y, z});
      const bool is_neck = z < -0.035;
      const cv::Vec3f behind =
          is_neck ? cv::Vec3f(static_cast<float>(neck[0] / 255), static_cast<float>(neck[1] / 255),
                              static_cast<float>(neck[2] / 255))
                  : back.at<cv::Vec3f>(row, column);
      const double rear = step(round - 1.5, 0.05);
      colour = (1 - rear) * colour + rear * behind;
      for (int i = 0; i < 3; ++i)
        head.at<cv::Vec3b>(row, column)[i] = cv::saturate_cast<std::uint8_t>(255 * colour[i]);
    }
  return head;
}

}  // namespace hc::room
