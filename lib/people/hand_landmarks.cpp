// SPDX-License-Identifier: Apache-2.0
#include <people/hand_landmarks.h>

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

#include <people/warp.h>

namespace hc::people {
namespace {

constexpr int kImage = 224;  // of the network's image [px]
constexpr int kCoordinates = 3 * Hand::kPoints;

cv::Mat input_of(const cv::Mat& image, const Region& region) {
  const float scale = region.side / kImage;
  const float cos = scale * std::cos(region.turn), sin = scale * std::sin(region.turn);
  constexpr float kMiddle = (kImage - 1) / 2.0F;
  const cv::Matx23f to_image(cos, -sin, region.middle.x - (cos - sin) * kMiddle, sin, cos,
                             region.middle.y - (sin + cos) * kMiddle);
  cv::Mat input, turned = warped(image, to_image, kImage, cv::BORDER_REPLICATE);
  if (turned.channels() == 1) cv::cvtColor(turned, turned, cv::COLOR_GRAY2RGB);
  turned.convertTo(input, CV_32F, 1 / 255.0);
  return input;
}

/// Whether numbers can be those of a hand in or beside an image. Those of foreign weights need not
/// even be finite: regions of images, and casts to int, rely on it.
bool is_hand(const Hand& hand, const cv::Size& image) {
  constexpr float kFar = 4;  // sides of the image
  const float most = kFar * static_cast<float>(std::max(image.width, image.height));
  constexpr float kLargest = 1;  // from the hand's middle [m]
  return hand.presence >= 0 && hand.presence <= 1 &&
         std::ranges::all_of(hand.points,
                             [&](const cv::Point2f& point) {
                               return std::abs(point.x) <= most && std::abs(point.y) <= most;
                             }) &&
         std::ranges::all_of(hand.world, [](const cv::Point3f& point) {
           return std::abs(point.x) <= kLargest && std::abs(point.y) <= kLargest &&
                  std::abs(point.z) <= kLargest;
         });
}

}  // namespace

Result<HandLandmarks> HandLandmarks::make(std::unique_ptr<nets::Network> network) {
  const auto refused = [&] {
    return Error{Code::Malformed, "not a network that finds the points of hands: its input is " +
                                      nets::text(network->input())};
  };
  if (network->input() != nets::Shape{kImage, kImage, 3}) return refused();
  const auto outputs = network->run(cv::Mat::zeros(kImage, kImage, CV_32FC3));
  if (outputs.size() != 4 || outputs[0].total() != kCoordinates || outputs[1].total() != 1 ||
      outputs[2].total() != 1 || outputs[3].total() != kCoordinates)
    return refused();
  return HandLandmarks(std::move(network));
}

Hand HandLandmarks::find(const cv::Mat& image, const Region& region) {
  const auto outputs = network_->run(input_of(image, region));
  const auto *in_image = outputs[0].ptr<float>(), *in_world = outputs[3].ptr<float>();
  const float cos = std::cos(region.turn), sin = std::sin(region.turn);
  Hand hand;
  for (std::size_t i = 0; i < Hand::kPoints; ++i) {
    const float *p = in_image + 3 * i, *w = in_world + 3 * i;
    const cv::Point2f from_middle(p[0] / kImage - 0.5F, p[1] / kImage - 0.5F);
    hand.points[i] =
        region.middle + region.side * cv::Point2f(cos * from_middle.x - sin * from_middle.y,
                                                  sin * from_middle.x + cos * from_middle.y);
    hand.world[i] = {cos * w[0] - sin * w[1], sin * w[0] + cos * w[1], w[2]};
  }
  hand.presence = outputs[1].at<float>(0);
  // The network was trained with mirrored images, as a person sees them who looks at the screen.
  hand.side = outputs[2].at<float>(0) > 0.5F ? Hand::Side::Right : Hand::Side::Left;
  return is_hand(hand, image.size()) ? hand : Hand();
}

}  // namespace hc::people
